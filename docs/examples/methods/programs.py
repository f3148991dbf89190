"""Programs as methods, for the command line: `footfall run closed-loop --methods pdr,programs.py:cpp`."""

import sys
from pathlib import Path

from footfall.hdr.methods import find_method

HERE = Path(__file__).parent

python = find_method(
    command=[sys.executable, str(HERE / "program.py"), "{recording}", "{track}", "{start}", "{params}"],
    name="python",
    params={"still_rate": 1.0},
)


def __getattr__(name):
    """The one in C++ is looked for when it is asked for: `c++ -O2 -o nav nav.cpp` comes first."""
    if name != "cpp":
        raise AttributeError(name)
    words = ["--in", "{recording}", "--out", "{track}", "--start", "{start}", "--set", "{params}"]
    return find_method(command=[str(HERE / "nav"), *words], name="cpp", params={"still_rate": 1.0})
