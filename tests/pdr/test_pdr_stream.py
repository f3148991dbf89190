"""A recording in blocks is dead-reckoned as a whole one, in memory for a few blocks."""

import tracemalloc
from dataclasses import replace
from functools import partial

import numpy as np
import pyarrow as pa
import pyarrow.csv as pa_csv
import pyarrow.parquet as pq
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.io import savemat

from footfall.columns import ACCEL, GYRO
from footfall.errors import InputError
from footfall.formats import open_source
from footfall.hdr.tracking import track
from footfall.pdr import stream
from footfall.pdr.detectors import DETECTORS
from footfall.pdr.reckoning import PdrParams, StartPose, dead_reckon
from footfall.pdr.rest import still_time
from footfall.pdr.stream import dead_reckon_blocks
from footfall.recording import Recording, write_recording
from tests.helpers.synthetic_foot import walk

HEADINGS = np.cumsum(np.random.default_rng(0).normal(0, 0.1, 40))
OPEN = pa_csv.open_csv
START = StartPose((1.0, -2.0, 0.5), 0.7)


@pytest.fixture(scope="module")
def walked():
    """With noise in every channel: of instants equally still either may be taken."""
    truth = walk(HEADINGS, still_s=6.0, pauses={10: 5.0, 11: 1.0, 20: 9.0})
    noise = np.random.default_rng(2).normal(0, 0.01, truth.accel.shape)
    recording = truth.recording(angle_random_walk=1e-4, accel_error=noise, seed=1)
    return replace(recording, temperature=20 - 0.1 * truth.t)


def blocks(recording, edges):
    for part in np.split(np.arange(len(recording.t)), edges):
        if len(part) > 1:
            warm = None if recording.temperature is None else recording.temperature[part]
            yield Recording(recording.t[part], recording.gyro[part], recording.accel[part], warm)


@settings(max_examples=40)
@given(
    edges=st.lists(st.integers(2, 9000), max_size=30).map(lambda x: sorted({edge - edge % 2 for edge in x})),
    work=st.sampled_from([100, 1000, 3000]),
    name=st.sampled_from([name for name in DETECTORS if name not in ("adaptive", "patient")]),
)
def test_blocks_make_the_footfalls_of_the_whole(walked, edges, work, name):
    params = PdrParams(bias_s=5.0, detector=DETECTORS[name])
    whole = dead_reckon(walked, params, START)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(stream, "WORK_ROWS", work)
        found, used = dead_reckon_blocks(blocks(walked, edges), params, START)
    assert used == 5.0
    for key in ("t", "position", "heading", "distance", "rate"):
        np.testing.assert_allclose(getattr(found, key), getattr(whole, key), rtol=0, atol=1e-9)
    for key, values in vars(whole.strides).items():
        np.testing.assert_allclose(getattr(found.strides, key), values, rtol=1e-9, atol=1e-6, err_msg=key)


@pytest.mark.parametrize("name", ["adaptive", "patient"])
def test_the_adaptive_detectors_differ_by_little(walked, monkeypatch, name):
    params = PdrParams(bias_s=5.0, detector=DETECTORS[name])
    whole = dead_reckon(walked, params)
    monkeypatch.setattr(stream, "WORK_ROWS", 1000)
    found, _ = dead_reckon_blocks(blocks(walked, range(500, 9000, 500)), params)
    assert len(found) == len(whole)
    assert np.abs(found.position - whole.position).max() < 0.02


def test_a_pause_longer_than_memory_is_one_footfall_still(monkeypatch):
    monkeypatch.setattr(stream, "WORK_ROWS", 500)
    monkeypatch.setattr(stream, "MOST_ROWS", 4000)
    recording = walk(HEADINGS[:12], still_s=6.0, pauses={5: 60.0}, tail_s=40.0).recording()
    params = PdrParams(bias_s=5.0)
    whole = dead_reckon(recording, params)
    found, _ = dead_reckon_blocks(blocks(recording, range(700, len(recording.t), 700)), params)
    assert len(found) == len(whole) == 12
    assert np.abs(found.t - whole.t).max() < 1.0  # instants of a pause are divided otherwise
    np.testing.assert_allclose(found.position, whole.position, atol=1e-3)


def test_the_rest_is_found_in_the_beginning(walked):
    params = PdrParams()
    found, used = dead_reckon_blocks(blocks(walked, range(300, 9000, 300)), params, rest_time=still_time)
    assert used == still_time(walked) == 5.5
    whole = dead_reckon(walked, replace(params, bias_s=used))
    np.testing.assert_allclose(found.position, whole.position, rtol=0, atol=1e-9)


def test_what_the_whole_refuses_is_refused(walked, monkeypatch):
    monkeypatch.setattr(stream, "WORK_ROWS", 500)
    monkeypatch.setattr(stream, "MOST_ROWS", 3000)
    params = PdrParams(bias_s=5.0)

    def refused(recording, match):
        with pytest.raises(InputError, match=match):
            dead_reckon_blocks(blocks(recording, range(400, len(recording.t), 400)), params)

    cut = (walked.t < 20.0) | (walked.t > 20.6)
    refused(Recording(walked.t[cut], walked.gyro[cut], walked.accel[cut]), "no samples for 0.6")
    still = walked.t < 5.9
    refused(Recording(walked.t[still], walked.gyro[still], walked.accel[still]), "no stride found")
    spinning = np.where(walked.t[:, None] > 8.0, 9.0, walked.gyro)
    refused(replace(walked, gyro=spinning), "no stance in the .* s after t = ")
    with pytest.raises(InputError, match="no rows"):
        dead_reckon_blocks(iter([]), params)


@settings(max_examples=10)
@given(st.data())
def test_a_file_in_blocks_makes_the_track_of_the_whole_file(tmp_path_factory, walked, data):
    """Lost and doubled rows lie on the blocks' edges too."""
    file = tmp_path_factory.getbasetemp() / "long.parquet"
    drop = data.draw(st.lists(st.integers(1500, 9000), max_size=8))
    twice = data.draw(st.lists(st.sampled_from([2047, 2048, 2049, 4096, 5000]), max_size=3, unique=True))
    rows = np.sort(np.append(np.setdiff1d(np.arange(len(walked.t)), drop), twice)).astype(int)
    write_recording(walked, file)
    write_rows(file, walked, rows)
    same = {"bias_s": 5.0, "detector": "threshold"}  # what is found of the whole alone
    ways = (("hdr", same), ("hde-2010", {"directions": 8, "reference": 0.4, **same}))
    wholes = [track(file, method, start=START, **told) for method, told in ways]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("footfall.hdr.tracking.WHOLE_ROWS", 1000)
        patch.setattr("footfall.formats.table.BLOCK_ROWS", 2048)
        patch.setattr(stream, "WORK_ROWS", 1000)
        in_blocks = [track(file, method, start=START, **told) for method, told in ways]
        with pytest.raises(InputError, match=r"long\.parquet: too long to be held at once"):
            track(file, "iez", bias_s=5.0)
    for found, whole in zip(in_blocks, wholes, strict=True):
        np.testing.assert_allclose(found.track.position, whole.track.position, rtol=0, atol=1e-9)
        for key in ("rows", "doubled", "filled"):
            assert getattr(found.findings, key) == getattr(whole.findings, key)


def write_rows(file, recording, rows):
    """Parquet with these rows, doubles and all, which no recording could hold."""
    columns = {"t": recording.t[rows]}
    columns |= {name: recording.gyro[rows, i] for i, name in enumerate(GYRO)}
    columns |= {name: recording.accel[rows, i] for i, name in enumerate(ACCEL)}
    pq.write_table(pa.table(columns), file)


def test_a_track_in_blocks_says_how_plausible_it_is(tmp_path, monkeypatch):
    truth = walk(np.zeros(12), still_s=6.0, rate=200.0)
    file = tmp_path / "long.parquet"
    write_recording(Recording(truth.t, truth.gyro, truth.accel), file)
    whole = track(file, "pdr", bias_s=5.0, detector="threshold").plausibility
    monkeypatch.setattr("footfall.hdr.tracking.WHOLE_ROWS", 1000)
    result = track(file, "pdr", bias_s=5.0, detector="threshold")
    found = result.plausibility
    assert result.track.meta["plausibility"] == found.as_dict()
    assert (found.strides, result.warnings) == (whole.strides, ())
    assert found.longest_stride_m == pytest.approx(whole.longest_stride_m)
    assert found.height_m == pytest.approx(whole.height_m, abs=1e-6)
    # From the quietest instant of a stance to that of the next: longer by parts of two stances.
    assert 0 <= found.longest_movement_s - whole.longest_movement_s < 1.0
    giant = walk(np.zeros(12), stride=4.0, still_s=6.0, rate=200.0)
    write_recording(Recording(giant.t, giant.gyro, giant.accel), file)
    with pytest.raises(InputError, match="legs make at most"):
        track(file, "pdr", bias_s=5.0, detector="threshold")


@pytest.mark.parametrize("format", ["footfall", "matlab"])
def test_a_file_is_opened_once(tmp_path, monkeypatch, format):
    """What is gone after it was opened could not be read again."""
    truth = walk(np.zeros(6), still_s=6.0, rate=200.0)
    file = tmp_path / ("a.mat" if format == "matlab" else "a.parquet")
    if format == "matlab":
        savemat(file, {"imu": np.hstack([truth.accel, truth.gyro]), "ts": 1 / 200})
    else:
        write_recording(Recording(truth.t, truth.gyro, truth.accel), file)

    def open_and_lose(path, *how, **told):
        source = open_source(path, *how, **told)
        file.unlink()
        return source

    monkeypatch.setattr("footfall.hdr.tracking.open_source", open_and_lose)
    result = track(file, "pdr")
    assert (result.findings.format, result.findings.rows) == (format, len(truth.t))


def test_memory_does_not_grow_with_the_file(tmp_path, monkeypatch):
    """Samples held at once take 56 bytes each, and five times that while they are worked on."""
    truth = walk(np.zeros(4), still_s=6.0, rate=200.0)
    values = np.column_stack([truth.gyro, truth.accel])
    first = truth.at(truth.mid_stance[1:2])[0]
    stride = values[first : first + 220]
    monkeypatch.setattr("footfall.formats.text.BLOCK_BYTES", 1 << 17)
    monkeypatch.setattr(stream, "WORK_ROWS", 1 << 13)

    def peak(strides):
        rows = np.concatenate([values[1:first], np.tile(stride, (strides, 1)), np.tile(stride[:1], (400, 1))])
        table = {"t": np.arange(len(rows)) / 200.0}
        table |= {key: rows[:, i] for i, key in enumerate((*GYRO, *ACCEL))}
        pa_csv.write_csv(pa.table(table), tmp_path / "a.csv")
        pool = pa.system_memory_pool()
        monkeypatch.setattr("footfall.formats.text.pa_csv.open_csv", partial(OPEN, memory_pool=pool))
        tracemalloc.start()
        result = track(tmp_path / "a.csv", "hdr")
        _, most = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        assert len(result.track) == strides + 2
        assert result.findings.rows == len(rows)
        return len(rows), most + pool.max_memory()

    monkeypatch.setattr("footfall.hdr.tracking.WHOLE_ROWS", 1000)
    peak(100)  # what is compiled and imported is no part of it
    (few, small), (many, large) = peak(200), peak(1200)
    assert (large - small) / (many - few) < 10
    monkeypatch.undo()
    assert peak(1200)[1] > 2 * large


@pytest.mark.parametrize("rows_a_group", [1 << 14, 1 << 20])
def test_parquet_is_read_page_by_page(tmp_path, rows_a_group):
    """However it is divided: Arrow holds no more of a long file than of a short one."""
    rng = np.random.default_rng(0)

    def peak(rows):
        table = {"t": np.arange(rows) / 200.0} | {name: rng.normal(size=rows) for name in (*GYRO, *ACCEL)}
        pq.write_table(
            pa.table(table), tmp_path / "a.parquet", row_group_size=rows_a_group, use_dictionary=False
        )
        table.clear()
        before, most, read = pa.total_allocated_bytes(), 0, 0
        for block in open_source(tmp_path / "a.parquet").blocks:
            read += len(block)
            most = max(most, pa.total_allocated_bytes() - before)
        assert read == rows
        return most

    short, long = peak(100_000), peak(400_000)  # 5.6 MB and 22.4 MB
    assert 0 < long < short + 2e6
