"""The bars that a student of a real character must pass; about 20 minutes on two cores (`make test-long`)."""

from pathlib import Path

import pytest
from shared_data import SharedData
from silent import Silent

from mua.baking.pipeline import bake
from mua.baking.settings import BakeSettings
from mua.baking.student_errors import TRAINING
from mua.student.settings import preset

LEAST_TRAINING = 0.80  # share of the variance about the mean texture
LEAST_HELD_OUT = 0.50  # on a walk, when walks are trained on


def bake_settings(shared_data: SharedData, directory: Path) -> BakeSettings:
    return BakeSettings(
        directory / "white.muaavatar",
        directory / "work",
        preset("preview"),
        "cpu",
        character=shared_data.path("characters/White_F_3_Casual.glb"),
        motions=(shared_data.path("motion/cmu"),),
        hold_out=("02_02", "01_05", "02_08", "02_09"),
    )


@pytest.fixture(autouse=True, scope="module")
def _small_atlases() -> None:
    """None: this character has the atlas that a user's has."""


@pytest.mark.long
def test_student_explains_a_clothed_woman(shared_data: SharedData, tmp_path: Path) -> None:
    errors = bake(bake_settings(shared_data, tmp_path), Silent()).errors
    for attribute in ("offset", "rotation", "SH"):
        assert errors[TRAINING].explained(attribute) >= LEAST_TRAINING
        assert errors["02_02"].explained(attribute) >= LEAST_HELD_OUT
