"""Reading a recording of any known format: opened, mended, and judged by physics."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from footfall.errors import InputError
from footfall.formats.bags import ULOG, is_bag, open_bag, open_ulog
from footfall.formats.condition import FILL_S, Findings, condition
from footfall.formats.diagnosis import Diagnosis, diagnose, unlagged
from footfall.formats.files import open_content
from footfall.formats.hdf5 import HDF5, is_apdm, open_apdm
from footfall.formats.layout import LAYOUTS
from footfall.formats.matlab import is_matlab, open_matlab
from footfall.formats.openshoe import is_openshoe, open_openshoe
from footfall.formats.options import Reading
from footfall.formats.phone import open_phone
from footfall.formats.physics import (
    check_alive,
    check_closure,
    check_gravity,
    check_values,
    check_walk,
    likely_units,
)
from footfall.formats.samples import Samples, Source, joined
from footfall.formats.table import open_table
from footfall.recording import Recording

FORMATS = ("auto", *LAYOUTS, "openshoe", "matlab", "apdm", "ros-bag", "ulog", "phone")
JUDGED_ROWS = 2000  # fewer tell nothing of a walk
WHOLE_ROWS = 2_000_000  # near three hours at 200 Hz, 0.8 GiB with all that is made of them


def open_source(
    path: str | os.PathLike[str],
    format: str = "auto",
    sizes: Mapping[str, float] | None = None,
    rate_hz: float | None = None,
    *,
    reading: Reading | None = None,
) -> Source:
    """Open a recording and find out its format.

    Parameters
    ----------
    format : one of `FORMATS`
    sizes : quantity -> size of its unit (`footfall.formats.units.parse_units`), for what the file leaves open
        or states wrongly
    rate_hz : samples per second, for a file without time
    reading : these two, and what else may be said of a file

    Raises
    ------
    InputError
        No such file or format, unreadable, or without the columns it should have.
    """
    source, reading = Path(path), reading or Reading()
    reading = replace(reading, sizes=sizes or reading.sizes, rate_hz=rate_hz or reading.rate_hz)
    if format not in FORMATS:
        raise InputError(f"format {format!r} is unknown, expected one of {', '.join(FORMATS)}")
    if rate_hz is not None and rate_hz <= 0:
        raise InputError(f"rate = {rate_hz:g} Hz: expected a positive number")
    if is_bag(source):
        return open_bag(source, reading)
    contents = open_content(source, reading.sensor)
    if len(contents) > 1 or format == "phone":
        return open_phone(source, contents, reading)
    (content,) = contents
    head = content.head
    if format == "openshoe" or (format == "auto" and is_openshoe(head)):
        if not is_openshoe(head):
            raise InputError("not a file of OpenShoe's recorder", source)
        return open_openshoe(content)
    if head.startswith(HDF5) and (format == "apdm" or (format == "auto" and is_apdm(content))):
        return open_apdm(content, reading)
    if format == "matlab" or (format == "auto" and is_matlab(content)):
        return open_matlab(content, reading)
    if format == "ulog" or head.startswith(ULOG):
        return open_ulog(content, reading)
    return open_table(content, format, reading)


def read(
    path: str | os.PathLike[str],
    format: str = "auto",
    *,
    sizes: Mapping[str, float] | None = None,
    rate_hz: float | None = None,
    reading: Reading | None = None,
    walk: bool = True,
) -> tuple[Recording, Findings]:
    """Read a whole recording, mend its samples (`condition`) and check it against physics.

    Parameters
    ----------
    format, sizes, rate_hz, reading : as in `open_source`
    walk : whether a walking foot is expected; False for a sensor at rest

    Returns
    -------
    The recording, in SI, with t from its first sample (Footfall's own keep theirs), and what was found.

    Raises
    ------
    InputError
        What `open_source`, `condition` and the checks of `footfall.formats.physics` refuse; or a walk of more
        than `WHOLE_ROWS` rows.
    """
    source = open_source(path, format, sizes, rate_hz, reading=reading)
    return read_source(source, walk=walk, gap_s=(reading or Reading()).gap_s)


def read_source(source: Source, *, walk: bool = True, gap_s: float = FILL_S) -> tuple[Recording, Findings]:
    """`read` of a file that is open: its samples are read now, and once.

    Raises
    ------
    InputError
        As `read`.
    """
    if walk and source.rows > WHOLE_ROWS:
        raise InputError(f"{source.rows} rows, expected at most {WHOLE_ROWS} to hold at once", source.path)
    try:
        samples = joined(source.blocks)
        # A simulated IMU loses nothing, and one without noise repeats itself at rest.
        samples, findings = condition(
            samples, source.format, gap_s=gap_s, doubted=not is_simulated(source.meta)
        )
        samples, told = likely_units(samples, source.unstated, walk)
        findings = replace(findings, notes=(*source.notes, *told))
        recording = as_recording(samples, source, findings)
        recording, findings = judged(recording, findings, walk)
    except InputError as error:
        raise error.about(source.path, "recording") from None
    return recording, findings


def is_simulated(meta: Mapping[str, Any]) -> bool:
    """Whether a recording's metadata tell that a simulated walk was recorded."""
    return "start" in meta


class Blocks:
    """A long recording, block by block: what `read` does, with memory for one block.

    Stamps that jitter are kept, for their spacing cannot be known before the end. `findings` are complete
    when the blocks have been run through.

    Parameters
    ----------
    source : opened; it is run through once
    gap_s : s, the longest hole in a swing that is filled

    Raises
    ------
    InputError
        While it is run through, as `read`.
    """

    def __init__(self, source: Source, gap_s: float = FILL_S) -> None:
        self.source, self.gap_s = source, gap_s
        self._found: Findings | None = None

    @property
    def findings(self) -> Findings:
        """What was found so far."""
        found = self._found or Findings(self.source.format, 0, 0.0)
        return replace(found, notes=tuple(self.source.notes))

    def __iter__(self) -> Iterator[Recording]:
        begin, seam = 0.0, None
        try:
            for block in self.source.blocks:
                if len(block) == 0:
                    continue
                if seam is None and self.source.format != "footfall":
                    begin = float(block.t[0])
                samples = block if seam is None else joined(iter([seam, block]))
                if len(samples) < 4:
                    seam = samples
                    continue
                samples, found = condition(
                    samples,
                    self.source.format,
                    whole=False,
                    gap_s=self.gap_s,
                    doubted=not is_simulated(self.source.meta),
                )
                again = replace(found, rows=len(block))
                self._found = again if self._found is None else merged(self._found, again)
                if len(samples) >= JUDGED_ROWS:
                    self._judge(as_recording(samples, self.source, found))
                # The last two samples join the next block: doubles and holes between blocks are seen.
                row = block.row + len(block) - 2
                seam = replace(samples.take(slice(-2, None)), row=row)
                yield _bare(samples.take(slice(-2)), begin)
            if seam is None:
                raise InputError("no rows of samples", "recording")
            yield _bare(seam, begin)
        except InputError as error:
            raise error.about(self.source.path, "recording") from None

    def _judge(self, recording: Recording) -> None:
        """Refuse the impossible; what else is wrong is sought once, for it takes longer than reading."""
        assert self._found is not None
        known = self._found.misclosure_g is not None
        found = judge(recording, self._found, walk=True, known=known)
        if found is None:
            return
        check_closure(found)
        if not known:
            self._found = replace(self._found, misclosure_g=found.misclosure, cause=found.cause)


def _bare(samples: Samples, begin: float) -> Recording:
    return Recording(samples.t - begin, samples.gyro, samples.accel, samples.temperature)


def as_recording(samples: Samples, source: Source, findings: Findings) -> Recording:
    """Mended samples as a recording, whose provenance says how they were read."""
    start = 0.0 if source.format == "footfall" else samples.t[0]
    return Recording(
        t=samples.t - start,
        gyro=samples.gyro,
        accel=samples.accel,
        temperature=samples.temperature,
        meta={**source.meta, "read": findings.as_dict()},
    )


def judged(recording: Recording, findings: Findings, walk: bool) -> tuple[Recording, Findings]:
    """The recording with its sensors at one time, and what is found about how its strides close.

    Raises
    ------
    InputError
        What the checks of `footfall.formats.physics` refuse.
    """
    found = judge(recording, findings, walk)
    if found is not None and found.lag_s:
        mended = unlagged(recording, found.lag_s)
        findings = replace(findings, lag_s=found.lag_s)
        found = diagnose(mended, clipped=True)
        recording = replace(mended, meta={**recording.meta, "read": findings.as_dict()})
    if found is None:
        return recording, findings
    check_closure(found)
    return recording, replace(findings, misclosure_g=found.misclosure, cause=found.cause)


def judge(recording: Recording, findings: Findings, walk: bool, known: bool = False) -> Diagnosis | None:
    """Every check of `footfall.formats.physics` that applies but that of how strides close, and how they do.

    known : whether a lag or a wrong clock would be no news

    Raises
    ------
    InputError
        What they refuse.
    """
    if walk:
        check_alive(recording)
    check_values(recording, dict(findings.clipped))
    check_gravity(recording)
    if not walk or not check_walk(recording):
        return None
    return diagnose(recording, known or bool(findings.clipped) or is_simulated(recording.meta))


def merged(first: Findings, second: Findings) -> Findings:
    """What was found in two blocks of one file."""
    clipped = dict(first.clipped)
    for name, count in second.clipped:
        clipped[name] = clipped.get(name, 0) + count
    shift = first.rows / first.rate_hz if first.rate_hz else 0.0
    return replace(
        first,
        rows=first.rows + second.rows,
        empty=first.empty + second.empty,
        doubled=first.doubled + second.doubled,
        disordered=first.disordered + second.disordered,
        lost=first.lost.and_also(second.lost),
        slower=first.slower or second.slower,
        doubtful=(*first.doubtful, *((shift + a, shift + b) for a, b in second.doubtful)),
        filled=first.filled + second.filled,
        longest_gap_s=max(first.longest_gap_s, second.longest_gap_s),
        jitter_pct=max(first.jitter_pct, second.jitter_pct),
        clipped=tuple(clipped.items()),
    )
