"""Frames of a recording beside each other, as the teacher means them."""

from collections.abc import Sequence

import numpy as np
from PIL import Image

from mua.arrays import Array
from mua.avatar.decode import pose_splats
from mua.avatar.rendering import render_premultiplied, to_bytes
from mua.baking.portrait import portrait
from mua.fidelity.background import background_for, over
from mua.fidelity.strips import caption
from mua.recording import WholeFrame
from mua.rig.rig import Rig

CELL = (360, 520)  # width, height, pixels


def frames_picture(rig: Rig, frames: Sequence[WholeFrame]) -> Image.Image:
    """A cell for each frame: its splats posed, from the front a little to the side, under the name of its clip."""
    return Image.fromarray(np.hstack([_cell(rig, frame) for frame in frames]))


def _cell(rig: Rig, frame: WholeFrame) -> Array:
    pose = frame.clip.pose(frame.index)
    splats = pose_splats(rig, frame.mesh, texture=frame.texture, pose=pose)
    drawn = render_premultiplied(splats, portrait(splats, rig.skeleton, pose=pose, screen=CELL))
    text = f"{frame.clip.name}, frame {frame.index}{' (held out)' if frame.clip.held_out else ''}"
    return np.vstack([caption([text], CELL[0]), to_bytes(over(drawn, background_for([drawn])))])
