"""A recording of a synthetic foot, and methods in files of their own."""

from textwrap import dedent

import numpy as np
import pytest

from footfall.hdr.methods import Reckoning
from footfall.pdr.reckoning import PdrParams, StartPose
from tests.helpers.synthetic_foot import walk

SHORT = PdrParams(bias_s=5.0)


@pytest.fixture(scope="module")
def recording():
    return walk(np.zeros(9), still_s=5.5).recording()


@pytest.fixture
def reckoning(recording):
    return Reckoning(recording, StartPose(heading=0.5), SHORT)


@pytest.fixture
def nav(tmp_path):
    """Writes a file of methods; returns the text that means one of them."""

    def write(body, name="Mine", file="nav.py"):
        head = "import numpy as np\nfrom footfall.pdr.track import Track\nfrom dataclasses import dataclass\n"
        (tmp_path / file).write_text(head + dedent(body))
        return f"{tmp_path / file}:{name}"

    return write
