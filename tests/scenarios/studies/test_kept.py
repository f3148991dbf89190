"""What was evaluated is found again, after whatever end."""

import numpy as np

from footfall.scenarios.studies.kept import BLOCK, Kept


def counting(calls):
    def work(new):
        calls.append(list(new))
        return np.array([[float(index), np.inf] for index in new])

    return work


def test_each_key_is_evaluated_once_and_in_blocks(tmp_path):
    calls = []
    kept = Kept(tmp_path, "made", 1)
    keys = [f"k{i % 40}" for i in range(80)]
    found = kept(keys, counting(calls))
    assert found.shape == (80, 2)
    assert [len(call) for call in calls] == [BLOCK, 40 - BLOCK]
    np.testing.assert_array_equal(found[:40], found[40:])
    assert np.isinf(found[:, 1]).all()
    again = Kept(tmp_path, "made", 1)(keys, counting(calls))
    assert len(calls) == 2
    np.testing.assert_array_equal(again, found)


def test_what_was_done_before_an_end_is_not_lost(tmp_path):
    """The last line was cut short, as by a full disk or a power cut."""
    calls = []
    Kept(tmp_path)(["a", "b", "c"], counting(calls))
    (file,) = tmp_path.iterdir()
    file.write_text(file.read_text()[:-4])
    found = Kept(tmp_path)(["a", "b", "c", "d"], counting(calls))
    assert calls[1] == [2, 3]
    np.testing.assert_array_equal(found[:, 0], [0, 1, 2, 3])
    np.testing.assert_array_equal(Kept(tmp_path)(["a", "b", "c", "d"], counting(calls)), found)
    assert len(calls) == 2


def test_other_makings_share_nothing_and_without_a_folder_nothing_is_written(tmp_path):
    calls = []
    Kept(tmp_path, 1)(["a"], counting(calls))
    Kept(tmp_path, 2)(["a"], counting(calls))
    Kept(None, 1)(["a"], counting(calls))
    assert len(calls) == 3
    assert len(list(tmp_path.iterdir())) == 2
