"""`footfall -v --log FILE`: what is logged where, and that nothing is left of it."""

import logging
import re

from tests.helpers.commands import expect_one_sentence


def test_a_log_is_written_to_its_end(cli, here):
    quiet = cli("record walk.parquet -o a.parquet")
    assert cli("--log my.log record walk.parquet -o a.parquet") == quiet
    assert cli("--log my.log record walk.parquet -o b.parquet")[0] == 0
    lines = (here / "my.log").read_text(encoding="utf-8").splitlines()
    assert [line.split(" ", 3)[3].split(":")[0].split(" ")[0] for line in lines if "footfall " in line] == [
        "footfall",
        "footfall",
    ]
    ended = [line for line in lines if re.search(r" INFO ended after \d+\.\d s$", line)]
    assert ended == lines[2::3]
    assert [line.rpartition(" ")[2] for line in lines if line not in ended] == [
        "record",
        "a.parquet",
        "record",
        "b.parquet",
    ]
    assert all(" INFO " in line for line in lines)
    assert not logging.getLogger("footfall").handlers


def test_verbose_tells_more_and_nothing_twice(cli, here):
    code, out, err = cli("-v run short.toml --walks 1 --units 1 --noises 0 --methods pdr --json")
    assert code == 0
    assert out.startswith("{")
    assert "of 2 recordings navigated" in err
    assert err.count("look at") == 1
    assert "navigated" not in cli("run short.toml --walks 1 --units 0 --noises 0 --methods pdr --json")[2]


def test_a_refusal_is_in_the_log(cli, here):
    code, _, err = cli("--log my.log record no.parquet -o x.parquet")
    assert code == 2
    *_, last, ended = (here / "my.log").read_text(encoding="utf-8").splitlines()
    assert " INFO ended after " in ended
    assert last.endswith(f" ERROR {err.removeprefix('footfall: ').strip()}")


def test_a_log_that_cannot_be_written_is_refused_before_the_work(cli, here):
    expect_one_sentence(
        *cli("--log no/such.log record walk.parquet -o x.parquet"), r"--log no/such\.log: cannot be written"
    )
    assert not (here / "x.parquet").exists()
