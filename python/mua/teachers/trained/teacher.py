"""A trained teacher by the protocol that recordings and distillations read (mua.teacher)."""

from collections.abc import Container, Iterator

import torch

from mua.arguments import PathLike, as_path
from mua.pose.clip import Clip
from mua.pose.skeleton import Pose
from mua.teacher import TeacherFrame
from mua.teachers.trained.drivable_template import Undeformed
from mua.teachers.trained.folder import load_teacher
from mua.teachers.trained.windows import windows


class TrainedTeacher:
    """Frames of any motion on the skeleton of `rig`, by the trained teacher of a folder."""

    def __init__(self, folder: PathLike, *, moving: bool = True) -> None:
        """Without `moving` only the mean texture on the skinned template, to compare with."""
        self.model, self.description = load_teacher(as_path(folder, "teacher"))
        self.rig = self.model.rig
        self._moving = moving
        if not moving:
            self.model.template.deformation = Undeformed(self.rig)

    def frames(self, clip: Clip, wanted: Container[int]) -> Iterator[TeacherFrame | Pose]:
        """Whole frames where wanted, else poses."""
        for index, window in enumerate(windows(self.rig.skeleton, self.description.encoding, clip)):
            if index not in wanted:
                yield clip.pose(index)
                continue
            with torch.no_grad():
                frame = self.model(window, moving=self._moving)
            yield TeacherFrame(clip.pose(index), frame.canonical.numpy(), frame.texture.numpy())
