"""Pictures of the walker, where there is something to draw with."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image


def draw(output: Path, *options: str) -> subprocess.CompletedProcess[str]:
    """`footfall render` in a process of its own: MuJoCo chooses what it draws with when first imported."""
    command = [sys.executable, "-m", "footfall.cli", "render", "straight", "-o", str(output), *options]
    result = subprocess.run(
        command, capture_output=True, text=True, env={**os.environ}, check=False, timeout=300
    )
    if "nothing to draw with" in result.stderr:
        assert result.returncode == 2
        assert not output.exists()
        pytest.skip("neither a screen nor EGL on this machine")
    return result


def test_a_strip_shows_a_walker_that_moves(tmp_path: Path) -> None:
    result = draw(tmp_path / "strip.png", "--skip", "3")
    assert result.returncode == 0, result.stderr
    strip = np.asarray(Image.open(tmp_path / "strip.png").convert("RGB")).astype(int)
    height, width, _ = strip.shape
    assert width > 5 * height / 2
    # The trousers are dark blue and below the middle; they are in each picture, and not at the same place.
    dark = (strip.sum(axis=2) < 250) & (strip[:, :, 2] > strip[:, :, 0] + 10)
    thirds = np.array_split(dark, 3, axis=1)
    assert all(part.sum() > 500 for part in thirds)
    assert not np.array_equal(thirds[0][:, :200], thirds[1][:, :200])


def test_a_moving_picture_has_frames(tmp_path: Path) -> None:
    result = draw(tmp_path / "walk.webp", "--seconds", "1")
    assert result.returncode == 0, result.stderr
    with Image.open(tmp_path / "walk.webp") as clip:
        assert clip.n_frames >= 14


def test_other_endings_are_refused(tmp_path: Path) -> None:
    result = draw(tmp_path / "walk.gif")
    assert result.returncode == 2
    assert "expected a name that ends in .webp or .png" in result.stderr
