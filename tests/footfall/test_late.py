"""A module that stands in for another until it is used."""

import subprocess
import sys

import pytest

from footfall.late import late


def test_the_module_is_imported_at_the_first_use():
    code = """
import sys
from footfall.late import late
colours = late("colorsys")
assert "colorsys" not in sys.modules
print(colours.rgb_to_hsv(1, 0, 0), "colorsys" in sys.modules)
"""
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert (found.stdout, found.stderr) == ("(0.0, 1.0, 1) True\n", "")


def test_what_is_not_there_is_refused_as_by_the_module_itself():
    with pytest.raises(AttributeError, match="module 'math' has no attribute 'sine'"):
        late("math").sine(1.0)
    with pytest.raises(ModuleNotFoundError, match="no_such_module"):
        late("no_such_module").anything()
