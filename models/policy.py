"""The walker's learned policy: a small perceptron, shipped as npz."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from footfall.errors import InputError
from footfall.models._policy_kernels import perceptron

_GAINS = (32,)  # of the balance feedback: simulate.walker.feedback


@dataclass(frozen=True)
class Policy:
    """Residual servo targets from observations.

    Attributes
    ----------
    weights, biases : of each layer, in single precision as they come from training; ELU between the layers,
        all in double precision
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
        """(n, n_observation) -> (n, n_action) mean action.

        Raises
        ------
        ValueError
            Observations of another length.
        """
        x = np.ascontiguousarray(observation, dtype=float)
        sizes, parameters = self._packed
        if x.shape[1:] != (sizes[0],):
            raise ValueError(f"observations {x.shape}, expected (n, {sizes[0]})")
        action = np.empty((len(x), sizes[-1]))
        perceptron(x, sizes, parameters, action)
        return action

    @cached_property
    def _packed(self) -> tuple[np.ndarray, np.ndarray]:
        """Sizes of the layers, the input's first, and weights and biases layer by layer."""
        layers = list(zip(self.weights, self.biases, strict=True))
        sizes = np.array([len(self.weights[0]), *(len(bias) for bias in self.biases)])
        return sizes, np.concatenate([part.ravel() for layer in layers for part in layer])


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
            weights, biases = (
                tuple(data[f"{name}_{i}"] for i in range(layers)) for name in ("weight", "bias")
            )
            gains = data["feedback_gains"]
            if gains.shape != _GAINS:
                raise ValueError(f"feedback gains {gains.shape}, expected {_GAINS}")
            meta = json.loads(str(data["meta"]))
    except (OSError, KeyError, ValueError) as error:
        raise InputError(f"not a walker policy ({error})", source) from None
    return Policy(weights, biases, gains, hashlib.sha256(content).hexdigest()[:16], meta)


@lru_cache(maxsize=1)
def stock_policy() -> Policy:
    """The shipped weights."""
    return load_policy(Path(str(files("footfall.models") / "weights" / "walker.npz")))
