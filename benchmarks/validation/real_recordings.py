"""Real feet: every detector and method on every recording, with one set of defaults.

Return error: horizontal distance from the last footfall to the first, for the foot ended where it began.
Where footprints were measured (gdin): their RMS distance from the track after the best rotation and shift,
each from the footfall nearest in time. Strides: found less true (the recorder's count, or one a footprint;
nobody counted those of openshoe 44 and xio: there it is the count of the default).

Then the same feet with the drift of other IMUs on top (`footfall record --from-recording`): by how much the
heading at the end then differs from that of undisturbed dead reckoning.

python -m benchmarks.validation.real_recordings --page docs/real_recordings.md \
    --figure docs/images/real_tracks.png
"""

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np
from rich.progress import track as progress

from benchmarks._common import out
from benchmarks._page import Sheet, by_name, fill
from benchmarks.validation._real import BESIDE, Real, find
from footfall import __version__
from footfall.errors import InputError
from footfall.formats.condition import condition
from footfall.formats.samples import Samples
from footfall.hdr.methods import METHODS, Reckoning
from footfall.hdr.tracking import REAL, RealReckoning
from footfall.models.imu import TemperatureProfile, draw_unit, load_spec
from footfall.pdr.detectors import DETECTORS
from footfall.pdr.reckoning import PdrParams
from footfall.pdr.rest import still_time
from footfall.pdr.rests import find_rest
from footfall.pdr.track import Track
from footfall.recording import Recording
from footfall.scenarios.judge.reference import score_closure, score_footprints
from footfall.simulate.from_recording import add_errors

STRIDES = {"openshoe 31": 50, "openshoe 44": 44, "xio long": 37, "xio short": 16}
TUNED_ON = ("openshoe 31", "gdin 32", "xio short")  # the detectors' constants; the others judge
# What is to be reached with one set of defaults: % of the distance, m to the footprints, m.
TARGETS = {"openshoe": 0.15, "gdin": 0.22, "xio": 0.16}
METHOD, DETECTOR = REAL  # the defaults of `footfall track`


@dataclass(frozen=True)
class Judged:
    """One method with one detector on one recording; `refused` says why there is no track."""

    recording: str
    detector: str
    method: str
    strides: int = 0
    strides_off: int = 0
    distance_m: float = np.nan
    return_m: float | None = None
    return_pct: float | None = None
    rmse_m: float | None = None
    unmatched: int = 0
    refused: str | None = None

    @property
    def error_m(self) -> float:
        """RMSE to the footprints, or return error where there are none."""
        error = self.return_m if self.rmse_m is None else self.rmse_m
        return np.nan if error is None else error


def reckoning(real: Real, detector: str, recording: Recording | None = None) -> Reckoning:
    """A recording with a detector, from the rest that there is, as `footfall track` takes it."""
    recording, params = recording or real.recording, PdrParams(detector=DETECTORS[detector])
    rest = find_rest(recording, params)
    bias_s = float(recording.t[rest.last] - recording.t[0])
    return RealReckoning(recording, pdr=replace(params, bias_s=bias_s), rest=rest)


def judge(real: Real, detector: str, method: str, track: Track) -> Judged:
    """A track beside the truth that there is."""
    closed, prints = score_closure(track), real.footprints
    true = STRIDES[real.name] if prints is None else len(prints) - 1
    found = Judged(real.name, detector, method, len(track) - 1, len(track) - 1 - true, closed.distance_m)
    if prints is None:
        return replace(found, return_m=closed.return_error_m, return_pct=closed.return_error_pct)
    laid = score_footprints(track, prints)
    return replace(found, rmse_m=laid.footprint_rmse_m, unmatched=laid.footprints - laid.matched)


def measure(reals: Sequence[Real]) -> tuple[list[Judged], dict[tuple[str, str], Track]]:
    """Everything on everything; the tracks are those of the default detector."""
    found, tracks = [], {}
    jobs = [(real, detector) for real in reals for detector in DETECTORS]
    for real, detector in progress(jobs, description="tracks", transient=True):
        given = reckoning(real, detector)
        for name, method in METHODS.items():
            try:
                track = method.track(given)
            except InputError as error:
                found.append(Judged(real.name, detector, name, refused=str(error)))
                continue
            found.append(judge(real, detector, name, track))
            if detector == DETECTOR:
                tracks[real.name, name] = track
    return found, tracks


def cell(one: Judged) -> str:
    """The figure that the recording is judged by."""
    if one.refused is not None:
        return "refused"
    return f"{one.error_m:.2f}" + (f" ({one.unmatched} lost)" if one.unmatched else "")


def sheets(reals: Sequence[Real], found: Sequence[Judged]) -> list[Sheet]:
    """Recordings; methods with the default detector; detectors with `pdr` and `iez`; strides; targets."""
    names = [real.name for real in reals]
    starred = [name + (" *" if name in TUNED_ON else "") for name in names]
    by = {(one.recording, one.detector, one.method): one for one in found}
    flaws = Sheet(
        "recordings",
        "Recordings and what their files suffer from",
        ["recording", "format", "Hz", "s", "rests s", "strides", "m", "flaws"],
    )
    targets = Sheet(
        "targets", f"Targets, with the defaults ({METHOD}, {DETECTOR})", ["recording", "reached", "target"]
    )
    for real in reals:
        one, t = by[real.name, DETECTOR, METHOD], real.recording.t
        figures = [f"{real.findings.rate_hz:.1f}", f"{t[-1]:.0f}", f"{still_time(real.recording):g}"]
        figures += [str(one.strides), f"{one.distance_m:.1f}"]
        told = "; ".join(real.findings.sentences()) or "none"
        flaws.rows.append([real.name, real.findings.format, *figures, told])
        value, unit = {
            "openshoe": (one.return_pct, "% of the distance"),
            "gdin": (one.rmse_m, "m to the footprints"),
            "xio": (one.return_m, "m from its start"),
        }[real.group]
        targets.rows.append([real.name, f"{value:.2f} {unit}", f"{TARGETS[real.group]:g}"])
    judged = "return error, m (gdin: RMSE to the footprints, m)"
    methods = Sheet("methods", f"Methods, detector {DETECTOR}: {judged}", ["method", *names])
    for name in METHODS:
        methods.rows.append([name, *(cell(by[real, DETECTOR, name]) for real in names)])
    made = [flaws, targets, methods]
    for method in ("pdr", "iez"):
        sheet = Sheet(f"detectors {method}", f"Detectors, method {method}: {judged}", ["detector", *starred])
        sheet.rows = [[name, *(cell(by[real, name, method]) for real in names)] for name in DETECTORS]
        made.append(sheet)
    strides = Sheet("strides", "Strides found less true, method pdr", ["detector", *starred])
    strides.rows = [
        [name, *(f"{by[real, name, 'pdr'].strides_off:+d}" for real in names)] for name in DETECTORS
    ]
    return [*made, strides]


@dataclass(frozen=True)
class Drifted:
    """Medians over units, by method.

    Attributes
    ----------
    recording : its name
    heading_deg : at the end, off that of undisturbed dead reckoning
    error_m : return error, or RMSE to the footprints
    """

    recording: str
    heading_deg: Mapping[str, float]
    error_m: Mapping[str, float]


def with_drift(reals: Sequence[Real], units: int, imu: str) -> list[Drifted]:
    """Each recording worn with the drift of `units` units of an IMU, cooling from 20 to -5 degC."""
    air, spec, found = TemperatureProfile.step(20.0, -5.0), load_spec(imu), []
    for real in progress(reals, description="added drift", transient=True):
        clean = METHODS["pdr"].track(reckoning(real, DETECTOR))
        heading: dict[str, list[float]] = {name: [] for name in METHODS}
        error: dict[str, list[float]] = {name: [] for name in METHODS}
        for seed in range(units):
            worse = add_errors(real.recording, draw_unit(spec, seed), seed=seed, temperature=air)
            given = reckoning(real, DETECTOR, worse)
            for name, method in METHODS.items():
                track = method.track(given)
                off = np.interp(track.t, clean.t, clean.heading) - track.heading
                heading[name].append(float(np.degrees(abs(off[-1] - off[0]))))
                error[name].append(judge(real, DETECTOR, name, track).error_m)
        medians = [
            {name: float(np.median(values)) for name, values in kind.items()} for kind in (heading, error)
        ]
        found.append(Drifted(real.name, *medians))
    return found


def drift_sheet(found: Sequence[Drifted], imu: str, units: int) -> Sheet:
    """One row a method: heading at the end, and the error that the recording is judged by."""
    title = (
        f"With the drift of {imu} on top, medians of {units} units: heading at the end off undisturbed pdr, "
        "deg / return error or RMSE, m"
    )
    sheet = Sheet("drift", title, ["method", *(one.recording for one in found)])
    for name in METHODS:
        sheet.rows.append(
            [name, *(f"{one.heading_deg[name]:.1f} / {one.error_m[name]:.2f}" for one in found)]
        )
    return sheet


def bias_times(reals: Sequence[Real]) -> Sheet:
    """How much hangs on T_bias, the time over which the static bias is averaged."""
    title = "pdr with another T_bias: return error or RMSE, m"
    sheet = Sheet("bias", title, ["T_bias s", *(real.name for real in reals)])
    for bias_s in (0.5, 1.0, 1.5, 2.0, 5.0, 10.0):
        row = []
        for real in reals:
            try:
                row.append(f"{dead_reckoned(real, real.recording, bias_s).error_m:.2f}")
            except InputError:  # it moves by then
                row.append("-")
        sheet.rows.append([f"{bias_s:g}", *row])
    found = [dead_reckoned(real, real.recording, None).error_m for real in reals]
    sheet.rows.append(["every rest", *(f"{error:.2f}" for error in found)])
    return sheet


def clipped_on_purpose(reals: Sequence[Real]) -> Sheet:
    """Gyros of smaller range: dead reckoning as they are, and with their peaks restored."""
    title = "pdr with gyros clipped on purpose: return error or RMSE, m, as clipped / restored"
    sheet = Sheet("clipped", title, ["range deg/s", *(real.name for real in reals)])
    for range_deg_s in (450, 400, 350, 300):
        limit, row = math.radians(range_deg_s), []
        for real in reals:
            whole = real.recording
            raw = Samples(0, whole.t, np.clip(whole.gyro, -limit, limit), whole.accel)
            both = (raw, condition(raw, "clipped")[0])
            errors = [
                dead_reckoned(real, replace(whole, gyro=samples.gyro), None).error_m for samples in both
            ]
            row.append(" / ".join(f"{error:.2f}" for error in errors))
        sheet.rows.append([f"{range_deg_s}", *row])
    return sheet


def dead_reckoned(real: Real, recording: Recording, bias_s: float | None) -> Judged:
    """`pdr` of a recording that was made of `real`; None for the rest that there is."""
    if bias_s is None:
        given = reckoning(real, DETECTOR, recording)
    else:
        given = Reckoning(recording, pdr=PdrParams(bias_s=bias_s, detector=DETECTORS[DETECTOR]))
    return judge(real, DETECTOR, "pdr", METHODS["pdr"].track(given))


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure, print and draw."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--data", type=Path, default=BESIDE, help="folder of recordings")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the figures there too")
    parser.add_argument("--page", type=Path, metavar="MD", help="put the tables into this page's marks")
    parser.add_argument("--figure", type=Path, metavar="PNG", help="draw the tracks over the footprints")
    parser.add_argument(
        "--units", type=int, default=10, help="units of the added drift (default 10; 0: none)"
    )
    parser.add_argument("--imu", default="nimu", help="whose drift is added (default nimu)")
    chosen = parser.parse_args(arguments)

    reals = find(chosen.data)
    if not reals:
        raise SystemExit(f"{chosen.data}: no recordings here")
    found, tracks = measure(reals)
    drifted = with_drift(reals, chosen.units, chosen.imu) if chosen.units else []
    made = [*sheets(reals, found), bias_times(reals), clipped_on_purpose(reals)]
    if drifted:
        made.append(drift_sheet(drifted, chosen.imu, chosen.units))
    for sheet in made:
        sheet.show()
    out.print(f"* the detectors' constants were chosen on these: {', '.join(TUNED_ON)}", markup=False)
    if chosen.page is not None:
        fill(chosen.page, by_name(made))
    if chosen.figure is not None:
        from benchmarks.validation._real_figure import draw

        draw(reals, tracks, chosen.figure)
    figures = [{key: value for key, value in asdict(one).items() if value == value} for one in found]
    if chosen.json is not None:
        document = {"footfall": __version__, "tracks": figures, "drift": [asdict(one) for one in drifted]}
        chosen.json.write_text(json.dumps(document, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
