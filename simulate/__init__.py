"""The walker's laws, its physics, and what comes out: walks, truths and recordings."""

from pathlib import Path as _Path

from footfall.compiled import forget_stale as _forget_stale

_room = _Path(__file__).parent
_forget_stale(_room, _room.parent / "models")
