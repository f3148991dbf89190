"""What a method is: a named way from a recording to a track, with parameters that have addresses."""

from __future__ import annotations

import pickle
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal

from footfall.errors import InputError
from footfall.hdr.tracks import Reckoning
from footfall.identity import plain
from footfall.pdr.track import Track
from footfall.settings import changed

# Files of a run beside its tracks, and areas of addresses.
TAKEN = ("footfalls", "recording", "drift", "scenario", "imu", "unit", "filter", "seed")

Needs = Literal["footfalls", "samples"]
Goes = Literal["none", "count", "all"]


@dataclass(frozen=True)
class Method:
    """A named way from recording to track. It pickles: methods travel between processes.

    Attributes
    ----------
    name : in tables, in files' names and in addresses
    description : one line for people
    run : makes the track from a `Reckoning` and `params`
    params : a frozen dataclass with its values, or a mapping of anything, or None for a method without
    needs : "footfalls" of the `Reckoning` alone, or "samples"
    directions : which dominant directions it takes: "none" uses none, "count" takes their number and learns
        them, "all" takes their number and one of them
    version : of the content of a method of others (`footfall.hdr.others`); "" for one built in
    use : text by which it was found, for a method of others
    """

    name: str
    description: str
    run: Callable[[Reckoning, Any], Track]
    params: Any = None
    needs: Needs = "samples"
    directions: Goes = "none"
    version: str = ""
    use: str = ""

    def track(self, reckoning: Reckoning) -> Track:
        """Navigate. The track's metadata tell the name and, of a method of others, version and params.

        Raises
        ------
        InputError
            What the method refuses, or what it did wrong.
        """
        made = self.run(reckoning, self.params)
        told = {"method": self.name}
        if self.version:
            told |= {"version": self.version, "use": self.use, "params": plain(self.params)}
        return replace(made, meta={**made.meta, **told})

    def with_params(self, values: Mapping[str, Any]) -> Method:
        """The same with other parameters, by their names at the edge: `{"theta_w_deg_s": 0.3}`.

        Raises
        ------
        InputError
            No such parameter, or a value that it refuses.
        """
        if isinstance(self.params, Mapping):
            return replace(self, params={**self.params, **values})
        return replace(self, params=changed(self.params, values))

    def renamed(self, name: str) -> Method:
        """The same under another name.

        Raises
        ------
        InputError
            Not a name for files and addresses.
        """
        return replace(self, name=require_name(name))

    def __reduce__(self) -> tuple[Callable[..., Method], tuple[str, bytes]]:
        # What a file defines can be unpickled only after that file was loaded.
        return _restored, (self.use, pickle.dumps(vars(self)))


def require_name(name: str) -> str:
    """Refuse what is no name for files and addresses: letters, digits, - and _; no file or area has it."""
    if name in TAKEN:
        raise InputError(f"method name {name!r}: this is Footfall's own name for something else")
    if not name or not name.replace("-", "a").replace("_", "a").isalnum():
        raise InputError(f"method name {name!r}: expected letters, digits, - and _")
    return name


def _restored(use: str, content: bytes) -> Method:
    if use:
        from footfall.hdr.others import ready

        ready(use)
    return Method(**pickle.loads(content))
