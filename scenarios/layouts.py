"""Ways that a seed draws: through rooms, where people turn every few metres, and along corridors.

What they hold is what real recordings indoors show: short straights, turns that take several strides, weaving
round what stands in the way, and directions that walls give, which not every leg keeps to.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache
from typing import Annotated, Literal

import numpy as np
from pydantic import Discriminator, Field, Tag

from footfall.addresses import parse
from footfall.scenarios.path import (
    MIN_RADIUS_M,
    Arc,
    Path,
    PathSpec,
    Straight,
    build_path,
)
from footfall.toml import Strict

STRIDE_M = 1.15  # of a walk indoors
RIGHT = math.pi / 2

Elements = list[Straight | Arc]


class DrawnPath(Strict):
    """A path of a kind, as long as told, drawn from the seed of each walk; level and open."""

    layout: Literal["rooms", "corridors"]
    length_m: Annotated[float, Field(ge=20, le=5000)]


def model_of(entry: object) -> type[PathSpec] | type[DrawnPath]:
    """Which of the two a table [path] is meant as."""
    drawn = isinstance(entry, DrawnPath) or (isinstance(entry, Mapping) and "layout" in entry)
    return DrawnPath if drawn else PathSpec


def concerns(address: str, entry: object) -> bool:
    """Whether an address of a document is none of its path, or one of the kind of path that it has."""
    area, *rest = parse(address)
    return area.name != "path" or rest[0].name in model_of(entry).model_fields


# Told apart by hand, so that an error speaks of the one that was meant.
PathEntry = Annotated[
    Annotated[PathSpec, Tag("PathSpec")] | Annotated[DrawnPath, Tag("DrawnPath")],
    Discriminator(lambda entry: model_of(entry).__name__),
]


@lru_cache(maxsize=64)
def laid_out(spec: PathSpec | DrawnPath, seed: int) -> Path:
    """The path of the walk with this seed.

    Raises
    ------
    InputError
        As `build_path`.
    """
    if isinstance(spec, PathSpec):
        return build_path(spec)
    return build_path(PathSpec(elements=drawn(spec, seed), vertical_transition_m=10.0))


def shortest(spec: PathSpec | DrawnPath) -> float:
    """Length (m) that the path of every walk has."""
    return spec.length_m if isinstance(spec, DrawnPath) else laid_out(spec, 0).route.length


def drawn(spec: DrawnPath, seed: int) -> tuple[Straight | Arc, ...]:
    """Elements of a path of `length_m` or a little more."""
    random = np.random.default_rng(seed)
    found: Elements = []
    left = spec.length_m
    for leg in _LEGS[spec.layout](random):
        found += leg
        left -= sum(map(_length, leg))
        if left <= 0:
            break
    return (*found, _straight(3.0))


def _rooms(random: np.random.Generator) -> Iterator[Elements]:
    """Legs of 3 to 10 m, every third round something, and turns over 3 to 6 strides.

    Seven of ten turns lead along a wall, give or take 4 deg, the others anywhere. They lead back where the
    way has gone more than 8 m from its start.
    """
    heading, place = 0.0, 0j
    yield [_straight(4.0)]
    place += 4.0
    while True:
        if random.random() < 0.7:
            aim = float(RIGHT * random.integers(4) + random.normal(0.0, math.radians(4.0)))
        else:
            aim = random.uniform(-math.pi, math.pi)
        turn = math.remainder(aim - heading, math.tau)
        onward = float((place * np.exp(-1j * (heading + turn))).real)  # m from its start, along the new leg
        if abs(turn) < math.radians(25.0) or (abs(place) > 8.0 and onward > 0):
            continue
        length = STRIDE_M * random.uniform(3.0, 6.0)
        leg: Elements = [_arc(turn, max(length / abs(turn), MIN_RADIUS_M))]
        if random.random() < 1 / 3:
            leg += _round_something(random, math.radians(random.uniform(20.0, 45.0)), 2.5)
        leg.append(_straight(random.uniform(3.0, 10.0)))
        heading, place = _after(leg, heading, place)
        yield leg


def _corridors(random: np.random.Generator) -> Iterator[Elements]:
    """Legs of 8 to 35 m between right angles, one in five back from a dead end; people are walked round."""
    yield [_straight(random.uniform(8.0, 35.0))]
    while True:
        side = random.choice([-1.0, 1.0])
        if random.random() < 0.2:
            leg: Elements = [_arc(side * math.pi, MIN_RADIUS_M)]
        else:
            leg = [_arc(side * RIGHT, random.uniform(1.5, 2.5))]
        for _ in range(random.integers(0, 3)):
            leg.append(_straight(random.uniform(4.0, 14.0)))
            leg += _round_something(random, math.radians(random.uniform(8.0, 20.0)), 3.0)
        leg.append(_straight(random.uniform(6.0, 14.0)))
        yield leg


_LEGS: Mapping[str, Callable[[np.random.Generator], Iterator[Elements]]] = {
    "rooms": _rooms,
    "corridors": _corridors,
}


def _round_something(random: np.random.Generator, angle: float, radius: float) -> Elements:
    """To one side and on, beside the line before."""
    angle *= random.choice([-1.0, 1.0])
    radius *= random.uniform(1.0, 2.0)
    return [_arc(angle, radius), _arc(-angle, radius)]


def _straight(length: float) -> Straight:
    return Straight(length_m=round(length, 3), grade_percent=0.0)


def _arc(turn: float, radius: float) -> Arc:
    return Arc(radius_m=round(radius, 3), turn_deg=round(math.degrees(turn), 3), grade_percent=0.0)


def _length(element: Straight | Arc) -> float:
    if isinstance(element, Straight):
        return element.length_m
    return element.radius_m * abs(element.turn)


def _after(leg: Elements, heading: float, place: complex) -> tuple[float, complex]:
    """Heading (rad) and place (m, x + iy) at the end of a leg."""
    for element in leg:
        turn = element.turn if isinstance(element, Arc) else 0.0
        chord = _length(element) * np.sinc(turn / math.tau)
        place += complex(chord * np.exp(1j * (heading + turn / 2)))
        heading += turn
    return heading, place
