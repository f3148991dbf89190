"""`footfall list`: what comes with Footfall."""

from __future__ import annotations

from footfall.cli.options import JsonOption
from footfall.cli.terminal import OUT, print_json


def list_(as_json: JsonOption = False) -> None:
    """Show what comes with Footfall: scenarios, IMUs, methods, detectors, mounts and sensor effects."""
    from footfall.hdr.methods import METHODS
    from footfall.hdr.others import entry_point_names
    from footfall.models.imu import EFFECTS, load_spec, stock_specs
    from footfall.models.mount import MOUNTS
    from footfall.pdr.detectors import DETECTORS, summary
    from footfall.scenarios.layouts import laid_out
    from footfall.scenarios.report.tables import new_table, titled
    from footfall.scenarios.scenario import ScenarioFile, read_document, stock_scenarios
    from footfall.toml import checked

    scenarios = {name: checked(read_document(name).table, ScenarioFile, name) for name in stock_scenarios()}
    imus = {name: load_spec(name).name for name in stock_specs()}
    methods = {name: method.description for name, method in METHODS.items()}
    methods |= {name: "of an installed package" for name in entry_point_names() if name not in METHODS}
    detectors = {name: summary(found) for name, found in DETECTORS.items()}
    if as_json:
        print_json(
            {
                "scenarios": {name: scenario.description for name, scenario in scenarios.items()},
                "imus": imus,
                "methods": methods,
                "detectors": detectors,
                "mounts": list(MOUNTS),
                "effects": list(EFFECTS),
            }
        )
        return
    table = new_table("name", "what", "length\nm", "pace\nm/s", "walks", left=2)
    for name, scenario in scenarios.items():
        length = laid_out(scenario.path, scenario.seeds.base).route.length
        pace, walks = f"{scenario.gait.pace_m_s:g}", f"{scenario.seeds.walks}"
        table.add_row(name, scenario.description, f"{length:.0f}", pace, walks)
    OUT.print(titled("Scenarios", table))
    for title, rows in (
        ("IMUs", imus),
        ("Methods, from a recording to a track", methods),
        ("Detectors of rest", detectors),
    ):
        table = new_table("name", "what", left=2)
        for name, text in rows.items():
            table.add_row(name, text)
        OUT.print(titled(title, table))
    OUT.print(f"[bold]Mounts of the IMU[/bold]: {', '.join(MOUNTS)}")
    OUT.print(f"[bold]Sensor effects[/bold], in their order: {', '.join(EFFECTS)}")
