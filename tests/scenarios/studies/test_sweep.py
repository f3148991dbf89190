"""A sweep: parts, one dataset, and going on where it was, with tasks that are performed without physics."""

import errno
import json

import pyarrow.parquet as pq
import pytest

from footfall.errors import InputError
from footfall.scenarios.studies import rows as rows_module
from footfall.scenarios.studies import sweep as sweeping
from footfall.scenarios.studies.parts import StudyFolder
from footfall.scenarios.studies.plan import plan_of
from footfall.scenarios.studies.rows import read_rows
from footfall.scenarios.studies.sweep import sweep
from footfall.scenarios.studies.task import StoppedError
from tests.helpers.study import Pretending, pretend, study

AXES = {"imu": ["nimu", "mtig710"], "hdr.theta_w_deg_s": [0.1, 0.2], "pdr.tilt_gain": [0.1, 0.2]}
CASES = {"walks": 2, "units": 40}


@pytest.fixture(autouse=True)
def no_tracks(monkeypatch):
    """They need walks, and the page needs them."""
    monkeypatch.setattr(sweeping, "write_tracks", lambda *given: False)
    monkeypatch.setattr("footfall.scenarios.report.page.write_page", lambda folder: None)


def small(**table):
    return study(**({"cases": CASES, "design": {"axes": AXES}} | table))


def done(made, folder, executor=None, **keys):
    """The last progress, and how many tasks were performed."""
    executor = executor or Pretending()
    *_, now = sweep(made, folder, executor, **keys)
    return now, len(executor.done)


def content(folder):
    return (folder / "results.parquet").read_bytes()


def test_a_study_becomes_one_sorted_dataset(tmp_path):
    now, tasks = done(small(), tmp_path)
    assert (now.stage, now.done, now.recordings, now.rows, now.failed) == ("finished", 80, 80, 480, 0)
    assert tasks == 8
    rows = small().results(tmp_path).table
    assert len(rows) == 480
    told = [
        (row["number"], row["imu"], row["pdr.tilt_gain"], row["hdr.theta_w_deg_s"] or 9, row["unit_seed"])
        for row in rows.to_pylist()
    ]
    assert told == sorted(told, key=lambda one: (*one[:2], one[2], one[3], one[4]))
    # What a row says of its axes is what its cell was made with.
    plan = plan_of(small())
    made = {cell.key: cell for task in plan.tasks for setting in task.settings for cell in setting.cells}
    for row in rows.to_pylist():
        method = made[row["key"]].method
        assert method.name == row["method"]
        told = row["hdr.theta_w_deg_s"]
        assert (told is None) == (method.name == "pdr")
        if told is not None:
            assert method == method.with_params({"theta_w_deg_s": told})
    assert json.loads((tmp_path / "study.json").read_text())["rows"] == 480
    assert len(pq.read_table(tmp_path / "timing.parquet")) == 8


def test_whatever_ends_it_the_dataset_is_the_same_and_nothing_is_done_twice(tmp_path):
    done(small(), tmp_path / "calm")
    counts = []
    for most in (1, 2, 1, 3, None):
        (tmp_path / "storm" / "parts").mkdir(parents=True, exist_ok=True)
        (tmp_path / "storm" / "parts" / ".half.parquet.x.tmp").write_bytes(b"PAR1 half")
        now, count = done(small(), tmp_path / "storm", Pretending(most))
        counts.append(count)
        assert now.stage == ("stopped" if most else "finished")
    assert counts == [1, 2, 1, 3, 1]
    assert content(tmp_path / "storm") == content(tmp_path / "calm")
    assert not list(tmp_path.glob("storm/**/*.tmp"))
    before = (tmp_path / "storm" / "results.parquet").stat().st_mtime_ns
    now, count = done(small(), tmp_path / "storm")
    assert (now.stage, count) == ("finished", 0)
    assert (tmp_path / "storm" / "results.parquet").stat().st_mtime_ns == before


def test_the_dataset_is_made_again_from_parts_alone(tmp_path):
    done(small(), tmp_path)
    before = content(tmp_path)
    for name in ("results.parquet", "study.json", "timing.parquet", ".timing.jsonl"):
        (tmp_path / name).unlink()
    assert done(small(), tmp_path)[1] == 0
    assert content(tmp_path) == before


def test_a_changed_study_keeps_the_parts_that_still_belong_to_it(tmp_path):
    done(small(), tmp_path / "one")
    wider = {"axes": AXES | {"imu": ["nimu", "mtig710", "perfect"]}}
    executor = Pretending()
    done(small(design=wider), tmp_path / "one", executor)
    assert len(executor.done) == 4
    sheets = {setting.documents.sheet.name for task in executor.done for setting in task.settings}
    assert sheets == {"perfect"}
    # A further value of hdr and a further method: nothing else of any task.
    more = {"axes": AXES | {"hdr.theta_w_deg_s": [0.1, 0.2, 0.3]}}
    executor = Pretending()
    done(small(design=more, methods=["pdr", "hdr", "hdr-basic"]), tmp_path / "one", executor)
    assert len(executor.done) == 8
    named = {cell.method.name for task in executor.done for one in task.settings for cell in one.cells}
    assert named == {"hdr", "hdr-basic"}
    assert all(len(task.cells) == 4 for task in executor.done)
    # As if it had never been another study; and back again, with nothing to do.
    done(small(design=more, methods=["pdr", "hdr", "hdr-basic"]), tmp_path / "new")
    assert content(tmp_path / "one") == content(tmp_path / "new")
    assert done(small(), tmp_path / "one")[1] == 0
    done(small(), tmp_path / "calm")
    assert content(tmp_path / "one") == content(tmp_path / "calm")


def test_rows_of_one_walk_that_was_walked_to_two_ends_are_refused(tmp_path):
    done(small(), tmp_path, Pretending(1))
    with pytest.raises(InputError, match=r"rows of walk \d+ are of walks that differ.*--fresh"):
        done(small(), tmp_path, Pretending(walk="of another processor"))
    assert done(small(), tmp_path, fresh=True)[0].stage == "finished"


def test_half_a_part_under_its_final_name_is_told_and_made_again(tmp_path):
    done(small(), tmp_path)
    before = content(tmp_path)
    (tmp_path / "results.parquet").unlink()
    first, second, *_ = sorted((tmp_path / "parts").iterdir())
    first.write_bytes(first.read_bytes()[:700])
    now, count = done(small(), tmp_path)
    assert count == 1
    assert now.warnings == (f"{first.name} was half written, and is made again",)
    assert content(tmp_path) == before
    # Damage that only reading finds.
    (tmp_path / "results.parquet").unlink()
    whole = second.read_bytes()
    second.write_bytes(whole[:10] + bytes(len(whole) - 60) + whole[-50:])
    with pytest.raises(InputError, match="was damaged, and is removed: start the sweep again"):
        done(small(), tmp_path)
    assert done(small(), tmp_path)[1] == 1
    assert content(tmp_path) == before


def test_failures_are_rows_and_are_done_again_when_asked(tmp_path):
    def some(row):
        return row.unit_seed == 1003 and row.method == "hdr"

    now, _ = done(small(), tmp_path, Pretending(failing=some))
    assert now.failed == 8
    lost = [row for row in read_rows(tmp_path / "results.parquet").to_pylist() if row["stage"]]
    assert {(row["unit_seed"], row["method"], row["error"]) for row in lost} == {(1003, "hdr", "it failed")}
    assert all(row["heading_error_mean_deg"] is None for row in lost)
    assert done(small(), tmp_path)[1] == 0
    now, count = done(small(), tmp_path, retry_failed=True)
    assert (count, now.failed) == (2, 0)
    done(small(), tmp_path / "calm")
    assert content(tmp_path) == content(tmp_path / "calm")


def test_tracebacks_are_kept_until_the_task_is_done_well(tmp_path):
    plan = plan_of(small())
    place = StudyFolder(tmp_path)
    with place.alone():
        told = pretend(plan.tasks[0], error="ZeroDivisionError: x")
        place.put(type(told)(**(vars(told) | {"tracebacks": "Traceback: x / 0"})))
        (file,) = (tmp_path / "errors").iterdir()
        assert file.stem == plan.tasks[0].key
        assert "x / 0" in file.read_text()
        place.put(pretend(plan.tasks[0]))
    assert not list((tmp_path / "errors").iterdir())


def test_fresh_forgets_and_touches_nothing_of_others(tmp_path):
    done(small(), tmp_path)
    (tmp_path / "notes.txt").write_text("mine")
    assert done(small(), tmp_path, fresh=True)[1] == 8
    assert (tmp_path / "notes.txt").read_text() == "mine"


def test_when_the_first_twenty_tasks_fail_alike_it_stops_and_keeps_none(tmp_path):
    many = study(cases={"walks": 1, "units": 210})
    executor = Pretending(error="the file map-17.csv is missing")
    with pytest.raises(InputError, match=r"the first 20 tasks all failed: the file map-17\.csv is missing"):
        done(many, tmp_path, executor)
    assert len(executor.done) == 20
    assert not list((tmp_path / "parts").iterdir())
    # One that goes well is enough to go on.
    now, count = done(many, tmp_path, Pretending(failing=lambda row: row.unit_seed != 1000))
    assert (now.stage, count) == ("finished", 21)
    # What fails later, after others have gone well, is a matter of the study.
    assert done(many.of(units=420), tmp_path, Pretending(error="no"))[0].stage == "finished"


def test_a_second_sweep_in_the_same_folder_is_refused(tmp_path):
    first = sweep(small(), tmp_path, Pretending())
    next(first)
    with pytest.raises(InputError, match="another sweep is at work in this folder"):
        next(sweep(small(), tmp_path, Pretending()))
    first.close()
    assert done(small(), tmp_path)[0].stage == "finished"


def test_a_full_disk_stops_it_and_it_goes_on_later(tmp_path, monkeypatch):
    real, written = rows_module.pq.write_table, []

    def write(table, where, **keys):
        written.append(1)
        if len(written) > 3:
            raise OSError(errno.ENOSPC, "No space left on device")
        real(table, where, **keys)

    with monkeypatch.context() as patch:
        patch.setattr(rows_module.pq, "write_table", write)
        with pytest.raises(StoppedError, match="No space left on device"):
            done(small(), tmp_path)
    assert len(list((tmp_path / "parts").iterdir())) == 3
    assert done(small(), tmp_path)[1] == 5
    done(small(), tmp_path / "calm")
    assert content(tmp_path) == content(tmp_path / "calm")


def test_a_folder_that_cannot_be_written_is_refused(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="file"):
        done(small(), tmp_path / "file")


def test_whoever_asks_stops_it_between_tasks(tmp_path):
    asked = []
    seen = []
    for now in sweep(small(), tmp_path, Pretending(), stop=lambda: bool(asked), on_progress=seen.append):
        if now.done == 30:
            asked.append(1)
    assert (now.stage, now.done) == ("stopped", 30)
    assert len(list((tmp_path / "parts").iterdir())) == 3
    shares = [one.share for one in seen]
    assert shares == sorted(shares)
    assert 0.2 < shares[-1] < 0.8
