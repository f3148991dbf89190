"""However a walk is written down, its recording is the same."""

import gzip
import io
import os
import zipfile

import numpy as np
import pyarrow as pa
import pytest

from footfall.conventions import GRAVITY
from footfall.errors import InputError
from footfall.formats import read
from footfall.formats.options import Reading
from footfall.recording import Recording
from tests.helpers.synthetic_foot import walk

RATE = 200.0
DEG = np.pi / 180


@pytest.fixture(scope="module")
def foot():
    """Eight strides, with a sensor's noise."""
    truth = walk(np.zeros(9), still_s=2.0, rate=RATE)
    noise = np.random.default_rng(0).normal(0, 1, (2, *truth.gyro[1:].shape))
    return Recording(
        truth.t[1:] - truth.t[1], truth.gyro[1:] + 2e-3 * noise[0], truth.accel[1:] + 2e-2 * noise[1]
    )


NAMES = ("t", "gx", "gy", "gz", "ax", "ay", "az")


def rows(foot, t="{:.4f}", size=(1.0, 1.0), decimals=6):
    """Cells as text, t first."""
    values = np.column_stack([foot.gyro / size[0], foot.accel / size[1]])
    stamps = [t(one) if callable(t) else t.format(one) for one in foot.t]
    return [[stamp, *(f"{x:.{decimals}f}" for x in row)] for stamp, row in zip(stamps, values, strict=True)]


def table(foot, names=NAMES, delimiter=",", head=(), below=(), **how):
    lines = [*head, delimiter.join(names), *below] if names else [*head]
    return "\n".join([*lines, *(delimiter.join(row) for row in rows(foot, **how))]) + "\n"


def same(path, foot, atol=2e-5, **how):
    found, findings = read(path, **how)
    np.testing.assert_allclose(found.t, foot.t, atol=1e-4)
    np.testing.assert_allclose(found.gyro, foot.gyro, atol=atol)
    np.testing.assert_allclose(found.accel, foot.accel, atol=10 * atol)
    return findings


def iso(s, sep="T", end=""):
    return (
        f"2024-02-29{sep}23:59:{50 + s:09.6f}{end}" if s < 10 else f"2024-03-01{sep}00:00:{s - 10:09.6f}{end}"
    )


WRITTEN = {
    "semicolons and decimal commas": lambda f: table(f, delimiter=";").replace(".", ","),
    "tabs": lambda f: table(f, delimiter="\t"),
    "bars": lambda f: table(f, delimiter="|"),
    "blanks": lambda f: table(f, delimiter="   ", head=["# a walk"]),
    "comma and blank": lambda f: table(f, delimiter=", "),
    "quoted": lambda f: table(f).replace(",", '","').replace("\n", '"\n"')[:-1].join(['"', ""]),
    "quoted decimal commas": lambda f: (
        '"' + table(f).replace(",", '";"').replace(".", ",").replace('";"', '","').replace("\n", '"\n"')[:-1]
    ),
    "a preamble": lambda f: table(f, head=["Device: foot", "Firmware: 1.2", "", "Rate: 200 Hz"]),
    "sep=": lambda f: table(f, delimiter=";", head=["sep=;"]),
    "comments": lambda f: "// made by hand\n# twice\n" + table(f),
    "a commented header": lambda f: "# " + table(f, delimiter=" "),
    "units below": lambda f: table(f, below=["s,rad/s,rad/s,rad/s,m/s^2,m/s^2,m/s^2"]),
    "units below in brackets": lambda f: table(
        f, below=["(s),(deg/s),(deg/s),(deg/s),(g),(g),(g)"], size=(DEG, GRAVITY)
    ),
    "a delimiter at the end": lambda f: table(f).replace("\n", ",\n"),
    "comments within": lambda f: table(f).replace("\n5.0000,", "\n# half way\n5.0000,"),
    "carriage returns": lambda f: table(f).replace("\n", "\r\n"),
    "date and time": lambda f: table(f, t=iso),
    "date and time with zone": lambda f: table(f, t=lambda s: iso(s, " ", "+01:00")),
    "time of day over midnight": lambda f: table(f, t=lambda s: iso(s)[11:]),
    "epoch ms": lambda f: table(f, t=lambda s: f"{1.7e12 + 1000 * s:.1f}"),
    "epoch us": lambda f: table(f, t=lambda s: f"{1.7e15 + 1e6 * s:.0f}"),
    "epoch ns": lambda f: table(f, t=lambda s: str(1_700_000_000_000_000_000 + round(1e9 * s))),
    "a counter of 16 bits": lambda f: table(
        f, ("t_ms", *NAMES[1:]), t=lambda s: f"{(65000 + 1000 * s) % 65536:.0f}"
    ),
    "seconds of a minute": lambda f: table(f, t=lambda s: f"{(52 + s) % 60:.3f}"),
    "deg/s and g that nothing states": lambda f: table(f, size=(DEG, GRAVITY)),
    "an index": lambda f: "\n".join(
        f"{i - 1 if i else ''},{line}" for i, line in enumerate(table(f).splitlines())
    ),
    "pandas' two levels": lambda f: (
        ",foot,foot,foot,foot,foot,foot\n,gyr_x,gyr_y,gyr_z,acc_x,acc_y,acc_z\n"
        "time [s],,,,,,\n" + table(f, ())
    ),
    "a doubled header": lambda f: table(f).replace("\n4.0000,", "\n" + ",".join(NAMES) + "\n4.0000,"),
}


@pytest.mark.parametrize("how", WRITTEN)
def test_a_walk_however_it_is_written(foot, tmp_path, how):
    (tmp_path / "a.csv").write_text(WRITTEN[how](foot), encoding="utf-8")
    same(tmp_path / "a.csv", foot, atol=1e-4)


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "cp1252"])
def test_a_walk_in_any_encoding(foot, tmp_path, encoding):
    names = ("t [s]", *(f"ω{a} [°/s]" if "16" in encoding else f"g{a} [°/s]" for a in "xyz"), *NAMES[4:])
    names = tuple(name.replace("ω", "gyro ") for name in names)
    text = table(foot, names, size=(DEG, 1.0))
    (tmp_path / "a.csv").write_bytes(text.encode(encoding))
    same(tmp_path / "a.csv", foot)


def test_names_that_are_given_stand_for_those_that_are_not_there(foot, tmp_path):
    (tmp_path / "a.txt").write_text(table(foot, ()))
    with pytest.raises(InputError, match="no line of names above its 7 columns") as caught:
        read(tmp_path / "a.txt")
    assert "--columns t,gyro_x,gyro_y,gyro_z,accel_x,accel_y,accel_z" in caught.value.more
    same(tmp_path / "a.txt", foot, reading=Reading(columns=NAMES))
    with pytest.raises(InputError, match="8 names were given for 7 columns"):
        read(tmp_path / "a.txt", reading=Reading(columns=(*NAMES, "temp")))


def test_names_that_mean_nothing_are_told_with_what_would_do(foot, tmp_path):
    (tmp_path / "a.csv").write_text(table(foot, tuple("abcdefg")))
    with pytest.raises(InputError, match=r"column 'gyro_x' is missing.*--columns") as caught:
        read(tmp_path / "a.csv")
    assert "no word for a quantity of an IMU" in caught.value.more
    line = caught.value.more.rpartition("--columns ")[2].split()[0]
    same(tmp_path / "a.csv", foot, reading=Reading(columns=tuple(line.split(","))))


def packed(kind, content):
    if kind == "gz":
        return gzip.compress(content)
    if kind == "zip":
        buffer = io.BytesIO()
        with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
            archive.writestr("../../escaped.csv", content)
            archive.writestr("__MACOSX/._a.csv", b"x")
        return buffer.getvalue()
    return pa.compress(content, codec={"zst": "zstd", "bz2": "bz2"}[kind], asbytes=True)


@pytest.mark.parametrize("kind", ["gz", "zip", "zst"])
def test_a_packed_file_is_unpacked(foot, tmp_path, kind):
    folder = tmp_path / "a" / "b"
    folder.mkdir(parents=True)
    (folder / f"a.csv.{kind}").write_bytes(packed(kind, table(foot).encode()))
    same(folder / f"a.csv.{kind}", foot)
    # A name in an archive becomes no path.
    assert sorted(path.name for path in tmp_path.rglob("*") if path.is_file()) == [f"a.csv.{kind}"]


@pytest.mark.parametrize("kind", ["gz", "zip", "zst"])
def test_what_expands_beyond_a_recording_is_refused(tmp_path, kind):
    (tmp_path / f"bomb.{kind}").write_bytes(packed(kind, b"0,0,0,0,0,0,0\n" * 4_000_000))
    with pytest.raises(InputError, match=r"expands to more than \d+ MiB"):
        read(tmp_path / f"bomb.{kind}")


@pytest.mark.parametrize("kind", ["gz", "zip", "zst"])
def test_a_damaged_archive_is_told_as_one(foot, tmp_path, kind):
    whole = packed(kind, table(foot).encode())
    (tmp_path / f"a.{kind}").write_bytes(whole[: len(whole) // 2])
    with pytest.raises(InputError, match="not a readable"):
        read(tmp_path / f"a.{kind}")


def test_two_tables_of_a_phone_are_joined(foot, tmp_path):
    """phyphox: each sensor at its own rate."""
    half = slice(0, None, 2)
    with zipfile.ZipFile(tmp_path / "walk.zip", "w") as archive:
        for name, unit, values, part in (
            ("Gyroscope", "rad/s", foot.gyro, slice(None)),
            ("Accelerometer", "m/s^2", foot.accel, half),
        ):
            lines = [f'"Time (s)","X ({unit})","Y ({unit})","Z ({unit})"']
            lines += [
                f"{t:.4f},{x:.6f},{y:.6f},{z:.6f}"
                for t, (x, y, z) in zip(foot.t[part], values[part], strict=True)
            ]
            archive.writestr(f"{name}.csv", "\n".join(lines))
        archive.writestr("meta/device.csv", '"property","value"\n"brand","x"\n')
    found, findings = read(tmp_path / "walk.zip")
    np.testing.assert_allclose(found.gyro, foot.gyro[: len(found.t)], atol=1e-5)
    np.testing.assert_allclose(found.accel[half], foot.accel[half][: len(found.accel[half])], atol=1e-5)
    assert findings.slower == (("accel", pytest.approx(100.0)),)


def test_several_sensors_are_listed_and_one_is_chosen(foot, tmp_path):
    lines = ["sensor," + ",".join(NAMES)]
    other = [["left", row[0], *row[4:], *row[1:4]] for row in rows(foot)]
    for right, left in zip(rows(foot), other, strict=True):
        lines += [",".join(["right", *right]), ",".join(left)]
    (tmp_path / "a.csv").write_text("\n".join(lines))
    with pytest.raises(
        InputError, match="2 sensors by its column 'sensor', choose one with --sensor: right, left"
    ):
        read(tmp_path / "a.csv")
    with pytest.raises(InputError, match="no sensor 'middle', but right, left"):
        read(tmp_path / "a.csv", reading=Reading(sensor="middle"))
    same(tmp_path / "a.csv", foot, reading=Reading(sensor="right"))
    unnamed = "\n".join(line.partition(",")[2] for line in lines)
    (tmp_path / "b.csv").write_text(unnamed)
    with pytest.raises(InputError, match="its rows come from 2 sensors by turns"):
        read(tmp_path / "b.csv")


def test_increments_become_rates(foot, tmp_path):
    names = ("t", *(f"dtheta_{a}" for a in "xyz"), *(f"dv_{a}" for a in "xyz"))
    (tmp_path / "a.csv").write_text(table(foot, names, size=(RATE, RATE), decimals=9))
    same(tmp_path / "a.csv", foot)


KINDS = {
    b"\x80\x04\x95": "a Python pickle, which is never opened",
    b"\x93NUMPY": "a NumPy array",
    b"%PDF-1.7": "a PDF document",
    b'[{"t": 0, "gx": 1}]': "a JSON document",
    b'{\n"t": [0], "gx": [1]}': "a JSON document",
    b"<!DOCTYPE html><table>": "a page of HTML or XML",
    b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1": "an Excel workbook",
    b"": "empty",
    b"just words\nand more of them\n": "no table of numbers",
}


@pytest.mark.parametrize("head", KINDS)
def test_a_file_of_another_kind_is_told_as_what_it_is(tmp_path, head):
    (tmp_path / "a.csv").write_bytes(head + (b"\x00" * 50 if head[:1] in b"\x80\x93\xd0" and head else b""))
    with pytest.raises(InputError, match=KINDS[head]):
        read(tmp_path / "a.csv")


def test_a_long_cell_that_is_no_number_is_cut_short_where_it_is_told(foot, tmp_path):
    """A logger that lost its power leaves zeros."""
    text = table(foot)
    (tmp_path / "a.csv").write_text(text[:60000] + "\0" * 512 + text[60000:])
    _, findings = read(tmp_path / "a.csv")
    (told,) = [one for one in findings.sentences() if "no numbers" in one]
    assert len(told) < 120


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
def test_what_is_no_file_is_told_as_what_it_is(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "loop").symlink_to(tmp_path / "loop")
    (tmp_path / "gone").symlink_to(tmp_path / "nothing")
    for name, what in (
        ("pipe", "a named pipe"),
        ("loop", "a link that leads back to itself"),
        ("gone", "a link that leads to a file that does not exist"),
        (".", "a folder"),
        ("none", "no such file"),
    ):
        with pytest.raises(InputError, match=what):
            read(tmp_path / name)
