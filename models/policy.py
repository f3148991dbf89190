"""The walker's learned policy: a small perceptron in plain numpy, shipped as npz."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from footfall.errors import InputError


@dataclass(frozen=True)
class Policy:
    """Residual servo targets from observations.

    Attributes
    ----------
    weights, biases : of each layer; ELU between them
    feedback_gains : (32,) of the balance feedback that the policy was trained on top of
    digest : hash of the weights, part of every walk's provenance
    meta : how they were made (command, seed, samples)
    """

    weights: tuple[np.ndarray, ...]
    biases: tuple[np.ndarray, ...]
    feedback_gains: np.ndarray
    digest: str
    meta: Mapping[str, Any] = field(default_factory=dict)

    def __call__(self, observation: np.ndarray) -> np.ndarray:
        """(n, n_observation) -> (n, n_action) mean action."""
        x = observation
        for weight, bias in zip(self.weights[:-1], self.biases[:-1], strict=True):
            x = x @ weight + bias
            x = np.where(x > 0, x, np.expm1(np.minimum(x, 0)))  # ELU
        return x @ self.weights[-1] + self.biases[-1]


def load_policy(path: str | Path) -> Policy:
    """Read weights from npz.

    Raises
    ------
    InputError
        The file is absent or is not a policy.
    """
    source = Path(path)
    try:
        content = source.read_bytes()
        with np.load(source) as data:
            layers = sum(name.startswith("weight_") for name in data.files)
            weights = tuple(data[f"weight_{i}"].astype(np.float64) for i in range(layers))
            biases = tuple(data[f"bias_{i}"].astype(np.float64) for i in range(layers))
            gains = data["feedback_gains"]
            meta = json.loads(str(data["meta"]))
    except (OSError, KeyError, ValueError) as error:
        raise InputError(f"{source}: not a walker policy ({error})") from None
    return Policy(weights, biases, gains, hashlib.sha256(content).hexdigest()[:16], meta)


@lru_cache(maxsize=1)
def stock_policy() -> Policy:
    """The shipped weights."""
    return load_policy(Path(str(files("footfall.models") / "weights" / "walker.npz")))
