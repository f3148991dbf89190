"""What determines a walk, a recording or a track, in metadata that travel with it.

A recording carries the identity of its walk, a track that of its recording besides.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields, is_dataclass
from typing import Any

import numpy as np

WALK = "walk"  # key of the walk's own metadata in those of what was made of it


@dataclass(frozen=True)
class WalkIdentity:
    """What makes one walk differ from another.

    Attributes
    ----------
    scenario : its name, which does not count: a copy of a scenario is the same walk
    scenario_digest : of the whole plan: path geometry, ground, body, mount, gait, stops, paces, pushes, seed
    seed : of the walk
    subject : name of the person
    mount : `name` of the mounting of the IMU and its pose on the shoe
    policy : digest of the walker's weights
    code : digest of the code and the physics engine that move the walker
    """

    scenario: str = field(compare=False)
    scenario_digest: str
    seed: int
    subject: str
    mount: Mapping[str, Any]
    policy: str
    code: str

    def as_dict(self) -> dict[str, Any]:
        """Plain values by name, for metadata."""
        return asdict(self)

    @property
    def digest(self) -> str:
        """SHA-256 (64 hex digits) of all that counts."""
        return digest_of({item.name: getattr(self, item.name) for item in fields(self) if item.compare})

    @classmethod
    def of(cls, meta: Mapping[str, Any]) -> WalkIdentity | None:
        """The identity in the metadata of a walk, or of a recording or track of it; None where not told."""
        told = meta.get(WALK, meta)
        if not isinstance(told, Mapping) or any(item.name not in told for item in fields(cls)):
            return None
        return cls(**{item.name: told[item.name] for item in fields(cls)})

    def __str__(self) -> str:
        mount = self.mount.get("name", "unknown")
        return (
            f"{self.scenario} (seed {self.seed}, subject {self.subject}, mount {mount}, "
            f"digest {self.digest[:8]})"
        )


def plain(value: Any) -> Any:
    """Settings as JSON can hold them.

    Dataclasses become dicts, tuples lists, what is not finite None, and any other object its class's name.
    """
    if is_dataclass(value) and not isinstance(value, type):
        return {item.name: plain(getattr(value, item.name)) for item in fields(value)}
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    if isinstance(value, np.generic):
        return plain(value.item())
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    return value if value is None or isinstance(value, (str, int)) else type(value).__name__


def digest_of(*values: Any) -> str:
    """SHA-256 (64 hex digits) of the content of values: plain ones, arrays, dataclasses, nests of them."""
    digest = hashlib.sha256()
    for value in values:
        _feed(digest, value)
    return digest.hexdigest()


def content_digest(*arrays: np.ndarray | None) -> str:
    """SHA-256 (64 hex digits) of kind, shape and bits of arrays; None for one that is not there."""
    digest = hashlib.sha256()
    for array in arrays:
        if array is None:
            digest.update(b"none")
            continue
        whole = np.ascontiguousarray(array)
        digest.update(f"({whole.dtype.str}{whole.shape}".encode())
        digest.update(whole.data)
    return digest.hexdigest()


def _feed(digest: Any, value: Any) -> None:
    """Take in `value`; everything with its kind and length, so that no two contents read the same."""
    if is_dataclass(value) and not isinstance(value, type):
        digest.update(f"<{type(value).__name__}>".encode())
        value = {item.name: getattr(value, item.name) for item in fields(value)}
    if isinstance(value, Mapping):
        digest.update(f"{{{len(value)}".encode())
        for key in sorted(value):
            _feed(digest, key)
            _feed(digest, value[key])
    elif isinstance(value, (list, tuple)):
        digest.update(f"[{len(value)}".encode())
        for item in value:
            _feed(digest, item)
    elif isinstance(value, np.ndarray):
        digest.update(f"({value.dtype.str}{value.shape}".encode() + np.ascontiguousarray(value).tobytes())
    elif isinstance(value, np.generic):
        _feed(digest, value.item())
    else:
        text = value.hex() if isinstance(value, bytes) else repr(value)
        digest.update(f"{type(value).__name__}{len(text)}:{text}".encode())
