"""The contact sheet: teacher, student and their difference side by side, on frames that the student never saw."""

from collections.abc import Iterable, Sequence
from functools import partial

import numpy as np
from PIL import Image

from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.avatar.decode import decode_clip_frame, pose_splats
from mua.avatar.rendering import render_premultiplied, to_bytes
from mua.baking.portrait import portrait
from mua.fidelity.background import background_for, over
from mua.fidelity.strips import GAIN, caption, difference, sheet
from mua.recording import WholeFrame
from mua.training.threads import in_order
from mua.training.torch_threads import few_threads

CELL = (288, 416)  # width, height, pixels
COLUMNS = 2  # frames beside each other


def contact_sheet(avatar: Avatar, frames: Iterable[WholeFrame], *, compared: Sequence[Array] = ()) -> Image.Image:
    """One image with three cells for each frame, below the strips that compare the source with the splats."""
    strips = list(compared)
    strips += [np.full_like(strips[0], 255)] * (len(strips) % COLUMNS) if strips else []
    strips += in_order(partial(_strip, avatar), frames, threads=few_threads())
    return sheet(strips, COLUMNS)


def _strip(avatar: Avatar, frame: WholeFrame) -> Array:
    """Teacher, student and difference of one frame [h, 3 w, 3], under a caption."""
    pose = frame.clip.pose(frame.index)
    teacher = pose_splats(avatar.rig, frame.mesh, texture=frame.texture, pose=pose)
    student = decode_clip_frame(avatar, frame.clip, frame=frame.index)
    camera = portrait(teacher, avatar.rig.skeleton, pose=pose, screen=CELL)
    drawn = [render_premultiplied(splats, camera) for splats in (teacher, student)]
    shown = [over(image, background_for(drawn[:1])) for image in drawn]
    picture = np.hstack([to_bytes(image) for image in (*shown, difference(*shown))])
    kind = "held out" if frame.clip.held_out else "trained on"
    titles = (f"teacher: {frame.clip.name}, frame {frame.index} ({kind})", "student", f"difference x{GAIN}")
    return np.vstack([caption(titles, CELL[0]), picture])
