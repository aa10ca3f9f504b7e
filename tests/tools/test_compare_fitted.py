"""Whole characters beside their source: both lines are printed, and the fit is worth something."""

import re

import pytest
from compare_fitted import main
from shared_data import SharedData

pytestmark = pytest.mark.usefixtures("first_try")


def test_fitted_splats_come_nearer_than_laid_ones(shared_data: SharedData, capsys: pytest.CaptureFixture[str]) -> None:
    main([str(shared_data.path("characters/lumberjack.glb")), "--texels", "64", "--steps", "12"])
    found = re.findall(r"lumberjack, (\w+): ([\d.]+) dB in the worst pose, ([\d.]+) in all", capsys.readouterr().out)
    (laid, *before), (fitted, *after) = found
    assert (laid, fitted) == ("laid", "fitted")
    assert all(float(one) < float(other) for one, other in zip(before, after, strict=True))
