"""The defaults that docs/navigation.md states are the program's."""

import math

import pytest

from footfall.hdr.hdr import HdrParams
from footfall.pdr.reckoning import PdrParams
from footfall.pdr.stance import StanceParams, ThresholdDetector
from tests.helpers.places import DOCS

PAGE = DOCS / "navigation.md"


def rows() -> dict[str, str]:
    """Setting -> default, of every table row that begins with a name in code."""
    cells = [
        line.split("|") for line in PAGE.read_text(encoding="utf-8").splitlines() if line.startswith("| `")
    ]
    return {row[1].strip().strip("`"): row[2].strip().strip("`") for row in cells}


PDR, HDR, STANCE, DETECTOR = PdrParams(), HdrParams(), StanceParams(), ThresholdDetector()


@pytest.mark.parametrize(
    ("name", "default"),
    [
        ("bias_s", f"{PDR.bias_s:g} s"),
        ("tilt_gain", f"{PDR.tilt_gain:g}"),
        ("max_gap_s", f"{PDR.max_gap_s:g} s"),
        (
            "detector",
            f"ThresholdDetector(gyro_max={math.degrees(DETECTOR.gyro_max):.6g} deg/s, "
            f"accel_max={DETECTOR.accel_max:g} m/s2, window_s={DETECTOR.window_s:g})",
        ),
        (
            "stance",
            f"StanceParams(min_stance_s={STANCE.min_stance_s:g}, min_stride_s={STANCE.min_stride_s:g}, "
            f"reset_s={STANCE.reset_s:g})",
        ),
        ("tau_s", f"{HDR.tau_s:g} s"),
        ("i_c", f"{math.degrees(HDR.i_c):.6g} deg/s"),
        ("theta_w", f"{math.degrees(HDR.theta_w):.6g} deg/s"),
    ],
)
def test_a_default_is_the_pages(name, default):
    assert rows()[name] == default
