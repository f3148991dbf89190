"""Reading a recording of any known format: opened, mended, and judged by physics."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path

from footfall.errors import InputError
from footfall.formats.condition import Findings, condition
from footfall.formats.layout import LAYOUTS
from footfall.formats.matlab import is_matlab, open_matlab
from footfall.formats.openshoe import is_openshoe, open_openshoe
from footfall.formats.physics import check_alive, check_gravity, check_values, check_walk
from footfall.formats.samples import Samples, Source, joined
from footfall.formats.table import open_table
from footfall.recording import Recording

FORMATS = ("auto", *LAYOUTS, "openshoe", "matlab")
JUDGED_ROWS = 2000  # fewer tell nothing of a walk
WHOLE_ROWS = 2_000_000  # near three hours at 200 Hz, 0.8 GiB with all that is made of them
_HEAD_BYTES = 1 << 16


def open_source(
    path: str | os.PathLike[str],
    format: str = "auto",
    sizes: Mapping[str, float] | None = None,
    rate_hz: float | None = None,
) -> Source:
    """Open a recording and find out its format.

    Parameters
    ----------
    format : one of `FORMATS`
    sizes : quantity -> size of its unit (`footfall.formats.units.parse_units`), for what the file leaves open
        or states wrongly
    rate_hz : samples per second, for a file without time

    Raises
    ------
    InputError
        No such file or format, unreadable, or without the columns it should have.
    """
    source, sizes = Path(path), sizes or {}
    if format not in FORMATS:
        raise InputError(f"format {format!r} is unknown, expected one of {', '.join(FORMATS)}")
    if rate_hz is not None and rate_hz <= 0:
        raise InputError(f"rate = {rate_hz:g} Hz: expected a positive number")
    if not source.is_file():
        raise InputError("no such file", source)
    with open(source, "rb") as file:
        head = file.read(_HEAD_BYTES)
    if not head:
        raise InputError("empty", source)
    if format == "openshoe" or (format == "auto" and is_openshoe(head)):
        if not is_openshoe(head):
            raise InputError("not a file of OpenShoe's recorder", source)
        return open_openshoe(source)
    if format == "matlab" or (format == "auto" and is_matlab(source, head)):
        return open_matlab(source, sizes)
    return open_table(source, head, format, sizes, rate_hz)


def read(
    path: str | os.PathLike[str],
    format: str = "auto",
    *,
    sizes: Mapping[str, float] | None = None,
    rate_hz: float | None = None,
    walk: bool = True,
) -> tuple[Recording, Findings]:
    """Read a recording whole, mend its samples (`condition`) and judge it by physics.

    Parameters
    ----------
    format, sizes, rate_hz : as in `open_source`
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
    return read_source(open_source(path, format, sizes, rate_hz), walk=walk)


def read_source(source: Source, *, walk: bool = True) -> tuple[Recording, Findings]:
    """`read` of a file that is open: its samples are read now, and once.

    Raises
    ------
    InputError
        As `read`.
    """
    if walk and source.rows > WHOLE_ROWS:
        raise InputError(f"{source.rows} rows, expected at most {WHOLE_ROWS} to hold at once", source.path)
    try:
        samples, findings = condition(joined(source.blocks), source.format)
        findings = replace(findings, notes=tuple(source.notes))
        recording = as_recording(samples, source, findings)
        judge(recording, findings, walk)
    except InputError as error:
        raise error.about(source.path, "recording") from None
    return recording, findings


class Blocks:
    """A long recording, block by block: what `read` does, with memory for one block.

    Stamps that jitter are kept, for their spacing cannot be known before the end. `findings` are complete
    when the blocks have been run through.

    Parameters
    ----------
    source : opened; it is run through once

    Raises
    ------
    InputError
        While it is run through, as `read`.
    """

    def __init__(self, source: Source) -> None:
        self.source = source
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
                samples, found = condition(samples, self.source.format, whole=False)
                again = replace(found, rows=len(block))
                self._found = again if self._found is None else merged(self._found, again)
                if len(samples) >= JUDGED_ROWS:
                    judge(as_recording(samples, self.source, found), found, walk=True)
                # The last two samples join the next block: doubles and holes between blocks are seen.
                row = block.row + len(block) - 2
                seam = replace(samples.take(slice(-2, None)), row=row)
                yield _bare(samples.take(slice(-2)), begin)
            if seam is None:
                raise InputError("no rows of samples", "recording")
            yield _bare(seam, begin)
        except InputError as error:
            raise error.about(self.source.path, "recording") from None


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


def judge(recording: Recording, findings: Findings, walk: bool) -> None:
    """Every check of `footfall.formats.physics` that applies.

    Raises
    ------
    InputError
        What they refuse.
    """
    if walk:
        check_alive(recording)
    check_values(recording, dict(findings.clipped))
    check_gravity(recording)
    if walk:
        check_walk(recording)


def merged(first: Findings, second: Findings) -> Findings:
    """What was found in two blocks of one file."""
    clipped = dict(first.clipped)
    for name, count in second.clipped:
        clipped[name] = clipped.get(name, 0) + count
    return replace(
        first,
        rows=first.rows + second.rows,
        empty=first.empty + second.empty,
        doubled=first.doubled + second.doubled,
        filled=first.filled + second.filled,
        longest_gap_s=max(first.longest_gap_s, second.longest_gap_s),
        jitter_pct=max(first.jitter_pct, second.jitter_pct),
        clipped=tuple(clipped.items()),
    )
