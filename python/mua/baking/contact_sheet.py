"""Images of recorded frames under captions: the teacher alone, or the contact sheet of teacher, student, difference."""

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
from mua.rig.rig import Rig
from mua.training.threads import in_order
from mua.training.torch_threads import few_threads

CELL, LARGE_CELL = (288, 416), (360, 520)  # width, height, pixels; of a contact sheet, of the teacher alone
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


def frames_picture(rig: Rig, frames: Sequence[WholeFrame]) -> Image.Image:
    """A cell for each frame: its splats posed, from the front a little to the side, under the name of its clip."""
    return Image.fromarray(np.hstack([_cell(rig, frame) for frame in frames]))


def _cell(rig: Rig, frame: WholeFrame) -> Array:
    pose = frame.clip.pose(frame.index)
    splats = pose_splats(rig, frame.mesh, texture=frame.texture, pose=pose)
    drawn = render_premultiplied(splats, portrait(splats, rig.skeleton, pose=pose, screen=LARGE_CELL))
    text = f"{frame.clip.name}, frame {frame.index}{' (held out)' if frame.clip.held_out else ''}"
    return np.vstack([caption([text], LARGE_CELL[0]), to_bytes(over(drawn, background_for([drawn])))])
