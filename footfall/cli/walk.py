"""`footfall walk`: one walk's truth."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich.progress import Progress

from footfall.cli.options import NoCacheOption, ScenarioArgument, SetOption
from footfall.cli.terminal import ERR, TABLES, finite, require_output, say
from footfall.errors import InputError


def walk(
    scenario: ScenarioArgument,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output", "-o", help="Parquet file to write; may be left out with --view.", show_default=False
        ),
    ] = None,
    seed: Annotated[
        int | None, typer.Option(min=0, help="Seed of this walk. Default: the scenario's.")
    ] = None,
    number: Annotated[
        int, typer.Option(min=1, help="Which of the scenario's walks. It decides subject and seed.")
    ] = 1,
    rate: Annotated[
        float | None,
        typer.Option(
            help="Sampling rate, Hz, a divisor of 1000. Default: the scenario's.",
            callback=finite,
        ),
    ] = None,
    mount: Annotated[
        str | None,
        typer.Option(
            help="Place of the IMU on the leg (see `footfall list`). Default: the scenario's. Several by "
            "commas are one walk in a file each: walk-heel.parquet."
        ),
    ] = None,
    view: Annotated[
        bool, typer.Option("--view", help="First show the walk in MuJoCo's viewer, which needs a screen.")
    ] = False,
    settings: SetOption = None,
    no_cache: NoCacheOption = False,
) -> None:
    """Walk a scenario once and write the truth: the motion of the IMU and the signals of a perfect one.

    The true footfalls go into a second file: walk.parquet and walk.footfalls.parquet.
    """
    from dataclasses import replace

    from footfall.models.mount import MOUNTS
    from footfall.scenarios.parameters import documents, parsed, require_areas, with_values
    from footfall.settings import did_you_mean
    from footfall.simulate.cache import cached_walk
    from footfall.simulate.plan import PHYSICS_STEP
    from footfall.simulate.truth import divisor
    from footfall.simulate.walk import write_walk
    from footfall.simulate.walking import walks

    if output is not None:
        require_output(output, TABLES)
    elif not view:
        raise InputError("Missing option '--output' / '-o' (see `footfall walk --help`)")
    require_areas(values := parsed(settings or ()), ("scenario",), "walk")
    plan = with_values(documents(scenario), values).setup().scenario.plan(number - 1, seed)
    mounts = list(dict.fromkeys(name.strip() for name in mount.split(","))) if mount else []
    for name in mounts:
        if name not in MOUNTS:
            raise InputError(f"--mount {name!r} is unknown{did_you_mean(name, MOUNTS)}")
    if mounts:
        plan = replace(plan, mount=MOUNTS[mounts[0]])
    if rate is not None:
        divisor(PHYSICS_STEP, rate)
        plan = replace(plan, rate_hz=rate)
    if view:
        from footfall.simulate.render import view as show

        show(plan)
    if output is None:
        return
    # The body feels no mount: it is walked once, and each place has its truth of the same steps.
    plans = {output: plan}
    if len(mounts) > 1:
        plans = {
            output.with_stem(f"{output.stem}-{name}"): replace(plan, mount=MOUNTS[name]) for name in mounts
        }
    every = list(plans.values())
    with Progress(console=ERR, transient=True, disable=not ERR.is_terminal) as progress:
        bar = progress.add_task(f"walking {output.stem}", total=plan.route.length)

        def walked(metres: float) -> None:
            progress.update(bar, completed=metres)

        def waiting() -> None:
            progress.update(bar, description="another process is walking this; waiting")

        truths = (
            walks(every, on_progress=walked)
            if no_cache
            else (cached_walk(one, also=every, on_progress=walked, on_wait=waiting) for one in every)
        )
        for file, truth in zip(plans, truths, strict=True):
            write_walk(truth, file)
            say(f"{len(truth.footfalls.t)} footfalls in {truth.t[-1]:.0f} s: {file}")
