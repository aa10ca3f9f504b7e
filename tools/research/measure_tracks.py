"""Print how far the texels of teachers are from the points of the person that they should show.

python tools/research/measure_tracks.py CAPTURE TEACHER...: CAPTURE has true tracks, also of clips that are held out, as
those of tools/render_capture.py do. Each point is compared with the nearest texel, moved as its splat is.
"""

import argparse
import tempfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import torch

from mua.capture import open_capture
from mua.channels import ATTRIBUTES
from mua.pose.clip import Clip
from mua.teachers.trained.drivable_template import Undeformed
from mua.teachers.trained.folder import load_teacher
from mua.teachers.trained.from_capture import Filmed, read_filmed
from mua.teachers.trained.model import TeacherModel
from mua.teachers.trained.tracked_points import tracks_of_clip


@torch.no_grad()
def away(
    teacher: TeacherModel,
    filmed: Filmed,
    clips: Sequence[Clip],
    *,
    moving: bool,  # False: the mean texture
) -> np.ndarray:
    """Millimetres of all points in all frames from where their texels have them."""
    found = []
    for clip in clips:
        for window, texels in zip(filmed.windows(clip), tracks_of_clip(filmed, clip), strict=True):
            frame = teacher(window, moving=moving)
            splats, offsets = teacher.splats(frame, window.joints[0]), frame.texture[:, ATTRIBUTES["offset"]]
            found.append(texels.places(frame.posed, splats, offsets) - texels.tracks.points)
    return 1000 * np.linalg.norm(np.concatenate(found), axis=1)


def summary(teacher: TeacherModel, filmed: Filmed, *, moving: bool) -> str:
    """Mean / 95 % on training poses, then in the clips held out."""
    apart = [away(teacher, filmed, clips, moving=moving) for clips in (filmed.clips, filmed.held)]
    return ", ".join(f"{np.mean(one):.1f} / {np.percentile(one, 95):.1f}" for one in apart)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("capture", type=Path, metavar="CAPTURE")
    parser.add_argument("teachers", type=Path, nargs="+", metavar="TEACHER")
    given = parser.parse_args()
    print("millimetres, mean / 95 %: training poses, clips held out")
    for folder in given.teachers:
        teacher, description = load_teacher(folder)
        with tempfile.TemporaryDirectory() as views:
            filmed = read_filmed(
                open_capture(given.capture), description.settings, torch.device("cpu"), views=Path(views)
            )
        print(f"{folder}: {summary(teacher, filmed, moving=True)}", flush=True)
        teacher.template.deformation = Undeformed(teacher.rig)
        print(f"{folder}, mean texture: {summary(teacher, filmed, moving=False)}", flush=True)


if __name__ == "__main__":
    main()
