"""Whatever a file holds, `footfall track` ends in a correct track or in one sentence and exit code 2."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.io import savemat

from footfall.columns import ACCEL, GYRO
from footfall.errors import InputError
from footfall.formats import read
from footfall.pdr.track import read_track
from footfall.recording import Recording, write_recording
from tests.footfall.test_formats import openshoe_lines
from tests.helpers.commands import expect_one_sentence, write_csv
from tests.helpers.synthetic_foot import walk

STRIDES = 8


def made(rate=200.0):
    truth = walk(np.zeros(STRIDES + 1), still_s=2.0, rate=rate)
    noise = np.random.default_rng(0).normal(0, 1e-3, (2, *truth.gyro.shape))
    return Recording(truth.t[1:] - truth.t[1], (truth.gyro + noise[0])[1:], (truth.accel + noise[1])[1:])


@pytest.fixture(scope="module")
def foot():
    return made()


def columns(foot, **changed):
    found = {"t": foot.t}
    found |= {name: foot.gyro[:, i] for i, name in enumerate(GYRO)}
    found |= {name: foot.accel[:, i] for i, name in enumerate(ACCEL)}
    return found | changed


def at(values, rows, value):
    values = values.copy()
    values[rows] = value
    return values


# Name -> (what becomes of the columns, the sentence)
CASES = {
    "no rows": (lambda c: {k: v[:0] for k, v in c.items()}, "no rows of samples"),
    "one row": (lambda c: {k: v[:1] for k, v in c.items()}, "1 samples|no table|no row"),
    "two rows": (lambda c: {k: v[:2] for k, v in c.items()}, "no sample|no stride|rest"),
    "shuffled": (lambda c: {k: v[::-1] for k, v in c.items()}, "t does not increase at row 1 "),
    "two recordings in one": (
        lambda c: {k: np.concatenate([v, v]) for k, v in c.items()},
        "t does not increase at row .* two recordings in one file",
    ),
    "one time": (lambda c: c | {"t": 0 * c["t"]}, "every row has the same time"),
    "NaN time": (lambda c: c | {"t": at(c["t"], slice(None, None, 3), np.nan)}, "t is not finite at row 0"),
    "all NaN": (
        lambda c: {k: v if k == "t" else v + np.nan for k, v in c.items()},
        "no row has both|no table",
    ),
    "constant": (lambda c: {k: v if k == "t" else 0 * v + 1.0 for k, v in c.items()}, "same in every row"),
    "zeros": (lambda c: {k: v if k == "t" else 0 * v for k, v in c.items()}, "same in every row"),
    "gyro dead": (lambda c: c | {name: 0 * c[name] for name in GYRO}, "gyros say the same in every row"),
    "saturated throughout": (
        lambda c: c | {name: np.sign(c[name]) * 8.7 for name in GYRO},
        "at the end of its range in",
    ),
    "accelerometers saturated": (
        lambda c: c | {name: np.clip(2 * c[name], -9.0, 9.0) for name in ACCEL},
        "accelerometers measure|end of its range",
    ),
    "10 Hz": (lambda c: {k: v[::20] for k, v in c.items()}, "sampled at 10 Hz, a walking foot needs 40 Hz"),
    "milliseconds": (lambda c: c | {"t": 1e3 * c["t"]}, "samples are 5 s apart.*probably in ms"),
    "g": (lambda c: c | {name: c[name] / 9.8 for name in ACCEL}, "probably in g"),
    "deg/s": (lambda c: c | {name: np.degrees(c[name]) for name in GYRO}, "gyros.*probably in deg/s"),
    "text": (lambda c: c | {"accel_y": [f"{x} m/s2" for x in c["accel_y"]]}, "'accel_y' holds '.* m/s2'"),
    "a hole": (
        lambda c: {k: np.delete(np.asarray(v), np.s_[1200:1300]) for k, v in c.items()},
        "no samples for 0.505 s after t = ",
    ),
    "no walk": (lambda c: {k: v[:350] for k, v in c.items()}, "no stride found after the"),
}


@pytest.mark.parametrize("name", CASES)
def test_bad_recordings_end_in_a_sentence(cli, foot, tmp_path, name):
    change, sentence = CASES[name]
    write_csv(tmp_path / "bad.csv", change(columns(foot)))
    expect_one_sentence(*cli(f"track {tmp_path}/bad.csv -o {tmp_path}/t.parquet"), sentence)
    assert not (tmp_path / "t.parquet").exists()


@pytest.mark.parametrize(
    "change",
    [
        lambda c: {k.replace("gyro", "turn"): v for k, v in c.items()},
        lambda c: {k: v for k, v in c.items() if k not in GYRO},
    ],
)
def test_columns_that_are_missing_are_told_with_those_that_are_there(cli, foot, tmp_path, change):
    write_csv(tmp_path / "bad.csv", change(columns(foot)))
    code, out, err = cli(f"track {tmp_path}/bad.csv -o {tmp_path}/t.parquet")
    sentence, _, table = err.partition("\n\n")
    expect_one_sentence(code, out, sentence + "\n", r"column 'gyro_x' is missing \(expected t, gyro_x")
    assert [line.split()[0] for line in table.splitlines()[:3]] == [
        "column",
        "t",
        list(change(columns(foot)))[1],
    ]
    assert "--columns" in table


SINGLE = {
    "NaN": lambda c: c | {"gyro_z": at(c["gyro_z"], 777, np.nan)},
    "inf": lambda c: c | {"accel_x": at(c["accel_x"], 778, -np.inf)},
    "an impossible row": lambda c: {k: v if k == "t" else at(v, 779, 32767.0) for k, v in c.items()},
    "a spike": lambda c: c | {"gyro_y": at(c["gyro_y"], 780, 60.0)},
    "NaN time": lambda c: c | {"t": at(c["t"], 781, np.nan)},
    "one stamp back": lambda c: c | {"t": at(c["t"], 782, 1.0)},
    "one stamp ahead": lambda c: c | {"t": at(c["t"], 783, 1e6)},
    "a row of zeros": lambda c: {k: v if k == "t" else at(v, 784, 0.0) for k, v in c.items()},
}


@pytest.mark.parametrize("name", SINGLE)
def test_one_bad_row_is_a_lost_sample(foot, tmp_path, name):
    write_csv(tmp_path / "a.csv", SINGLE[name](columns(foot)))
    found, findings = read(tmp_path / "a.csv")
    np.testing.assert_allclose(found.t, foot.t, atol=1e-9)
    np.testing.assert_allclose(found.gyro, foot.gyro, atol=0.2)
    assert any("1 lost samples filled in" in said for said in findings.sentences())
    assert findings.filled == 1


def test_a_walk_that_is_under_way_is_navigated_from_its_first_stance(cli, foot, tmp_path):
    begun = {k: v[560:] for k, v in columns(foot).items()}
    write_csv(tmp_path / "a.csv", begun)
    code, _, err = cli(f"track {tmp_path}/a.csv -o {tmp_path}/t.parquet")
    assert code == 0, err
    track = read_track(tmp_path / "t.parquet")
    np.testing.assert_allclose(np.diff(track.position[:, 0]), 1.5, atol=0.05)
    assert len(track) >= STRIDES - 1


@pytest.mark.parametrize("rate", [50.0, 100.0, 5000.0])
def test_slow_and_fast_sensors_are_tracked_alike(cli, tmp_path, rate):
    write_recording(made(rate), tmp_path / "a.parquet")
    code, _, err = cli(f"track {tmp_path}/a.parquet --method pdr -o {tmp_path}/t.parquet")
    assert code == 0, err
    track = read_track(tmp_path / "t.parquet")
    assert len(track) == STRIDES + 1
    np.testing.assert_allclose(track.position[:, 0], 1.5 * np.arange(STRIDES + 1), rtol=0.02, atol=0.05)
    np.testing.assert_allclose(track.heading, 0.0, atol=0.01)


def test_what_loggers_do_changes_the_track_by_little(cli, foot, tmp_path):
    """Doubled rows, one in a hundred lost, stamps that jitter and a swing that is clipped: each is told."""
    rng = np.random.default_rng(1)
    rows = np.sort(np.concatenate([np.flatnonzero(rng.random(len(foot.t)) > 0.01), rng.integers(9, 999, 20)]))
    limit = 0.97 * np.abs(foot.gyro[:, 1]).max()
    clipped = np.clip(foot.gyro[:, 1], -limit, limit)
    values = {k: np.asarray(v)[rows] for k, v in columns(foot, gyro_y=clipped).items()}
    write_csv(tmp_path / "bad.csv", values)
    code, _, err = cli(f"track {tmp_path}/bad.csv --method pdr -o {tmp_path}/t.parquet")
    assert code == 0
    told = " ".join(err.split())  # a narrow terminal breaks lines
    for sentence in ("doubled rows left out", "lost samples filled in", "gyro_y is clipped in"):
        assert sentence in told
    track = read_track(tmp_path / "t.parquet")
    assert track.meta["read"]["clipped"]["gyro_y"] > 0
    np.testing.assert_allclose(track.position[:, 0], 1.5 * np.arange(STRIDES + 1), rtol=0.03, atol=0.05)


def sentence_or_recording(path):
    said = None
    try:
        found, _ = read(path)
    except InputError as error:
        said = str(error)
    if said is not None:
        assert said.startswith(f"{path}: ")
        assert "\n" not in said
        return None
    assert all(np.isfinite(values).all() for values in (found.t, found.gyro, found.accel))
    return found


@pytest.fixture(scope="module")
def files(foot, tmp_path_factory):
    """One recording in every kind of file, as bytes."""
    folder = tmp_path_factory.mktemp("files")
    write_csv(folder / "a.csv", columns(foot))
    write_recording(foot, folder / "a.parquet")
    (folder / "a.txt").write_text("\n".join(openshoe_lines(foot)))
    savemat(folder / "a.mat", {"imu": np.column_stack([foot.accel, foot.gyro]), "ts": foot.t})
    return {path.name: path.read_bytes() for path in folder.iterdir()}


@settings(max_examples=60)
@given(st.data())
def test_a_file_cut_anywhere_is_refused_or_read_as_far_as_it_goes(files, foot, tmp_path_factory, data):
    name = data.draw(st.sampled_from(sorted(files)))
    size = data.draw(st.integers(0, len(files[name])))
    path = tmp_path_factory.getbasetemp() / f"cut-{name}"
    path.write_bytes(files[name][:size])
    found = sentence_or_recording(path)
    if found is not None:
        assert name in ("a.csv", "a.txt") or size == len(files[name])
        # A number may be cut short in the last row, as far as anyone can tell.
        sure = len(found.t) - 1
        np.testing.assert_allclose(found.gyro[:sure], foot.gyro[:sure], atol=1e-6)
        np.testing.assert_allclose(found.accel[:sure], foot.accel[:sure], atol=1e-5)


@settings(max_examples=60)
@given(st.data())
def test_a_file_with_damaged_bytes_is_no_traceback(files, tmp_path_factory, data):
    name = data.draw(st.sampled_from(sorted(files)))
    whole = bytearray(files[name])
    for place in data.draw(st.lists(st.integers(0, len(whole) - 1), min_size=1, max_size=4)):
        whole[place] = data.draw(st.integers(0, 255))
    path = tmp_path_factory.getbasetemp() / f"damaged-{name}"
    path.write_bytes(whole)
    sentence_or_recording(path)


@settings(max_examples=60)
@given(st.binary(max_size=400), st.sampled_from(["csv", "parquet", "mat", "txt"]))
def test_any_bytes_are_refused(tmp_path_factory, content, ending):
    path = tmp_path_factory.getbasetemp() / f"any.{ending}"
    path.write_bytes(content)
    assert sentence_or_recording(path) is None


@settings(max_examples=40)
@given(st.data())
def test_columns_of_any_numbers_are_no_silent_track(foot, tmp_path_factory, data):
    """One channel replaced by arbitrary numbers, some not finite, some huge."""
    name = data.draw(st.sampled_from(["t", *GYRO, *ACCEL]))
    value = st.floats(allow_nan=True, allow_infinity=True, width=32)
    few = data.draw(st.lists(value, min_size=1, max_size=5))
    path = tmp_path_factory.getbasetemp() / "numbers.csv"
    write_csv(path, columns(foot, **{name: np.resize(few, len(foot.t))}))
    with np.errstate(all="ignore"):
        found = sentence_or_recording(path)
    assert found is None or name != "t"
