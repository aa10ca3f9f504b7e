"""mua-capture check names the parts of the person that no training camera shows."""

import re
from dataclasses import replace
from pathlib import Path

import pytest
from captures import SIDE, make_capture
from commands import Commands
from PIL import Image

from mua.capture import Capture, write_capture
from mua.capture.check import check_capture

UPPER = (0, 0, SIDE, SIDE // 2)  # half of an image: left, upper, right and lower edge


def to_upper_halves(capture: Capture, *, held_out: bool) -> Capture:
    """The capture, whose training cameras, and the held-out ones on request, show the upper half of the person."""
    cropped = [camera for camera in capture.cameras if held_out or not camera.held_out]
    for camera in cropped:
        for file in capture.folder.glob(f"images/*/{camera.name}/*.png"):
            Image.open(file).crop(UPPER).save(file)
    changed = tuple(camera.cropped(UPPER) if camera in cropped else camera for camera in capture.cameras)
    halved = replace(capture, cameras=changed)
    write_capture(halved)
    return halved


@pytest.mark.parametrize("held_out", [True, False])
def test_legs_outside_all_training_images_are_worth_a_remark(tmp_path: Path, held_out: bool, command: Commands) -> None:
    """Also where a camera that no training uses shows them."""
    capture = make_capture(tmp_path / "halved")
    assert check_capture(capture, frames=0).remarks == ()
    halved = to_upper_halves(capture, held_out=held_out)
    checked = check_capture(halved, frames=0)
    assert checked.problems == ()
    (remark,) = checked.remarks
    found = re.match(r"No training camera shows (\d\d)% of the template in .*, most of it at (.*): it will", remark)
    assert found is not None, remark
    assert 20 <= int(found[1]) < 70
    assert not {"Head", "LeftHand", "RightHand"} & set(found[2].split(", "))
    ended = command("capture", "check", halved.folder, "--frames", 0)
    assert ended.status == 0
    assert f"remark: {remark}" in ended.out
