"""`footfall render`: pictures of the walker."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from footfall.cli.options import ScenarioArgument
from footfall.cli.terminal import ERR, finite, require_output, say


def render(
    scenario: ScenarioArgument,
    output: Annotated[Path, typer.Option("--output", "-o", help="WebP or PNG file to write.")],
    number: Annotated[
        int, typer.Option(min=1, help="Which of the scenario's walks. It decides the person who walks.")
    ] = 1,
    skip: Annotated[
        float, typer.Option(min=0, help="Start of the picture, s after the first step.", callback=finite)
    ] = 4.0,
    seconds: Annotated[
        float, typer.Option(min=0.5, max=60, help="Length of a moving picture, s.", callback=finite)
    ] = 4.0,
    signals: Annotated[
        bool, typer.Option("--signals", help="What the IMU says beside a moving picture.")
    ] = False,
) -> None:
    """Draw the walker at the beginning of a walk: moving (.webp) or as a strip of moments (.png).

    Without a screen it draws by EGL. MUJOCO_GL chooses another way.
    """
    from footfall.scenarios.scenario import load_scenario
    from footfall.simulate.render import render as draw

    require_output(output, ".webp" if signals else (".webp", ".png"))
    plan = load_scenario(scenario).plan(number - 1)
    with ERR.status("walking and drawing"):
        pictures = draw(plan, output, skip=skip, seconds=seconds, signals=signals)
    say(f"{pictures} pictures: {output}")
