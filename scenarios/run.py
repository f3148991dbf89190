"""What `footfall run` does: each walk of a scenario with its unit, other units and other noises beside it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, replace

from footfall.errors import InputError
from footfall.pdr.track import Track
from footfall.recording import Recording
from footfall.scenarios.execute import Progress, execute
from footfall.scenarios.judge.score import Score
from footfall.scenarios.trial import Outcome, Setup, Trial
from footfall.simulate.budget import DriftBudget
from footfall.simulate.walk import Walk

OTHER_UNITS_FROM = 1000  # seeds of the units that are reported beside the scenario's own
OTHER_NOISES_FROM = 5000  # seeds of the noises that the walks' own units are heard through once more


@dataclass(frozen=True)
class Part:
    """One walk of a run.

    Attributes
    ----------
    own : the walk with its unit
    others : further units of the same sheet on it, each with the noise of its own seed
    noises : its unit heard through further noises
    """

    own: Trial
    others: tuple[Trial, ...] = ()
    noises: tuple[Trial, ...] = ()


@dataclass(frozen=True)
class Result:
    """What one walk of a run gave.

    Attributes
    ----------
    scores : method -> score; tracks : method -> track
    others, noises : one method -> score mapping for each further unit, and for each further noise
    """

    trial: Trial
    walk: Walk
    recording: Recording
    budget: DriftBudget
    tracks: Mapping[str, Track]
    scores: Mapping[str, Score]
    others: tuple[Mapping[str, Score], ...] = ()
    noises: tuple[Mapping[str, Score], ...] = ()


def parts(
    setup: Setup,
    *,
    walks: int | None = None,
    seed: int | None = None,
    other_units: int = 0,
    noises: int = 0,
) -> list[Part]:
    """The walks of a run; arguments left out are the scenario's.

    `other_units` further units (seeds from 1000) are shared out over the walks; each walk's own unit is heard
    through `noises` further noises, which no other walk has (seeds from 5000).

    Raises
    ------
    InputError
        The scenario stands still for too short a time before it walks.
    """
    scenario = setup.scenario
    if scenario.sensor.calibration_s < setup.pdr.bias_s:
        raise InputError(
            f"{scenario.name}: sensor.calibration_s = {scenario.sensor.calibration_s:g}: "
            f"a run averages the static bias over sensor.bias_time_s = {setup.pdr.bias_s:g} s at rest"
        )
    count = scenario.seeds.walks if walks is None else walks
    base = scenario.seeds.base if seed is None else seed
    # Another sheet's units, or walks beyond the scenario's own, are simply drawn.
    chosen = setup.imu == scenario.imu and seed is None
    made = []
    for number in range(count):
        unit = scenario.unit_seed(number) if chosen else base + number
        own = Trial(setup, number, walk_seed=base + number, unit_seed=unit, noise_seed=unit)
        further = range(OTHER_UNITS_FROM + number, OTHER_UNITS_FROM + other_units, count)
        again = range(OTHER_NOISES_FROM + number, OTHER_NOISES_FROM + noises * count, count)
        made.append(
            Part(
                own,
                tuple(replace(own, unit_seed=other, noise_seed=other) for other in further),
                tuple(replace(own, noise_seed=noise) for noise in again),
            )
        )
    return made


def perform_run(
    todo: Sequence[Part],
    *,
    workers: int | None = None,
    use_cache: bool = True,
    on_progress: Callable[[Progress], None] | None = None,
) -> list[Result]:
    """Perform every part; arguments as of `execute`.

    Raises
    ------
    InputError
        What any step refuses: a fall, a broken recording, a method's own mistake.
    """
    trials: list[Trial] = []
    own, results = [], []
    for part in todo:
        own.append(len(trials))
        trials += [part.own, *part.others, *part.noises]
    with closing(
        execute(trials, workers=workers, use_cache=use_cache, keep=own, on_progress=on_progress)
    ) as found:
        for part in todo:
            first = next(found)
            further = [next(found).scores for _ in (*part.others, *part.noises)]
            results.append(_result(first, further, len(part.others)))
    return results


def _result(own: Outcome, further: Sequence[Mapping[str, Score]], units: int) -> Result:
    scores, kept = own.scores, own.kept
    assert kept is not None
    return Result(
        trial=own.trial,
        walk=kept.walk,
        recording=kept.recording,
        budget=kept.budget,
        tracks=kept.tracks,
        scores=scores,
        others=tuple(further[:units]),
        noises=tuple(further[units:]),
    )
