"""What the tests of the command line share."""

import csv
import json
import re

import pytest

SCORES = {
    "heading_error_mean_deg",
    "heading_error_final_deg",
    "return_error_pct",
    "distance_error_pct",
    "position_rmse_m",
    "position_error_final_m",
}


def one_document(out):
    """Standard output, which must be exactly one JSON document without NaN."""
    return json.loads(out, parse_constant=lambda name: pytest.fail(f"{name} is no JSON"))


def expect_one_sentence(code, out, err, culprit):
    """What every mistake must end in."""
    assert code == 2
    assert out == ""
    assert err.startswith("footfall: ")
    assert err.endswith("\n")
    assert len(err.splitlines()) == 1
    assert "Traceback" not in err
    assert re.search(culprit, err), err


def content(folder):
    """Every file of a folder with its size and time, and every folder."""
    return {
        path: (path.stat().st_size, path.stat().st_mtime_ns) if path.is_file() else None
        for path in folder.rglob("*")
    }


def write_csv(path, columns):
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        writer.writerows(zip(*columns.values(), strict=True))
