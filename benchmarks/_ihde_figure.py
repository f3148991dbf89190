"""The figures of ihde_table2.py."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from footfall.hdr.tracks import Reckoning
from footfall.pdr.track import Track
from footfall.scenarios.figures import maps, save
from footfall.scenarios.heading_figures import evaluation
from footfall.scenarios.run import Result, Task, perform, start_pose
from footfall.scenarios.scenario import Scenario

if TYPE_CHECKING:
    from ihde_table2 import Tuned

_SHOWN = ("iez", "hde", "ihde")


def _result(scenario: Scenario, seed: int, tuned: Tuned) -> Result:
    """One walk with the unit of its seed, navigated by the paper's methods on its own filter, matched."""
    from ihde_table2 import Way

    result = perform(Task(scenario, seed - scenario.seed, seed, seed, scenario.imu, ("pdr",)))
    reckoning = Reckoning(result.recording, start_pose(result.walk))
    methods, settings = tuned.methods(), tuned.matched(scenario.name)
    tracks: dict[str, Track] = {name: Way(methods[name], settings).track(reckoning) for name in _SHOWN}
    return replace(result, tracks=tracks)


def draw(folder: Path, scenarios: Mapping[str, Scenario], tuned: Tuned, seed: int) -> None:
    """Tracks on the three tests (the paper's Figures 6b, 7b and 8), and E along Test 2 (Figure 7a)."""
    folder.mkdir(parents=True, exist_ok=True)
    results = {test: _result(scenario, seed, tuned) for test, scenario in scenarios.items()}
    figure = maps(list(results.values()), "Walked paths, and three methods on the paper's filter")
    for axis, (test, scenario) in zip(figure.axes, scenarios.items(), strict=True):
        axis.set_title(f"{test}, {scenario.path.route.length:.0f} m", loc="left", fontsize=9)
    save(figure, folder / "ihde_tracks.png")
    title = "ihde-test2: heading, and what IHDE makes of it"
    save(evaluation(results["ihde-test2"], title), folder / "ihde_evaluation.png")
