"""Errors of a student by attribute, in units that mean something to a person."""

import numpy as np
import pytest

from mua.baking.student_errors import Errors, Picture, held_out_errors
from mua.channels import ATTRIBUTES, SH_C0
from mua.pose.clip import Clip
from mua.recording import WholeFrame

CLIP = Clip("walk", 30.0, np.tile([1.0, 0, 0, 0], (1, 1, 1)), np.zeros((1, 1, 3)))
HALF = np.radians(1) / 2


def errors(attribute: str, values: list[float]) -> Errors:
    """Of one frame, whose image differs in the attribute of every texel, or in the mesh."""
    texture, mesh = np.zeros((5, 23), np.float32), np.zeros((7, 3), np.float32)
    texture[:, ATTRIBUTES["rotation"]] = [1, 0, 0, 0]
    other, moved = texture.astype(float), mesh.astype(float)
    if attribute == "mesh":
        moved = moved + values
    else:
        other[:, np.arange(23)[ATTRIBUTES[attribute]][: len(values)]] = values
    found = Errors()
    found.add(WholeFrame(CLIP, 0, 0, mesh, texture), {"student": Picture(other, moved)})  # type: ignore[arg-type]
    return found


@pytest.mark.parametrize(
    ("attribute", "values", "read"),
    [
        ("offset", [0.003, 0, 0.004], 5),  # millimetres
        ("mesh", [0, 0.002, 0], 2),
        ("rotation", [np.cos(HALF), 0, np.sin(HALF), 0], 1),  # degrees
        ("scale", [0, np.log(1.01), 0], 1),  # per cent
        ("opacity", [0.5], 0.5),
        ("SH", [0, 1 / 255 / SH_C0], 1),  # steps of 8 bits
    ],
)
def test_an_error_is_read_in_the_unit_of_its_attribute(attribute: str, values: list[float], read: float) -> None:
    assert errors(attribute, values).rms(attribute, "student") == pytest.approx(read, rel=0.01)


def test_groups_together_have_the_errors_of_all_their_frames() -> None:
    groups = {"training": errors("opacity", [9]), "a": errors("opacity", [3]), "b": errors("opacity", [4])}
    held = held_out_errors(groups)
    assert held is not None
    assert held.frames == 2
    assert held.rms("opacity", "student") == pytest.approx(np.sqrt((3**2 + 4**2) / 2))
    assert held_out_errors({"training": errors("opacity", [9])}) is None
