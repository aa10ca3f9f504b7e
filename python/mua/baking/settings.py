"""What a bake or a check is to do; known before anything that takes seconds is loaded."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from mua.asset.tensors import Storage
from mua.atlas.detail import Detail, UvMode
from mua.baking.shared_options import DeviceName
from mua.characters.alpha import Alphas
from mua.characters.facing import AS_SHOWN, Facing
from mua.characters.figure_size import AS_FOUND, FigureSize
from mua.motion.planted_feet import Feet
from mua.student.settings import Settings
from mua.teachers.trained.settings import TeacherSettings

ALL, NONE = "all", "none"  # clips to store for playback
MotionRange = Literal["full", "none"]


@dataclass(frozen=True)
class BakeSettings:
    """One character, its motion, and what is to become of them, as the options of mua-bake say."""

    output: Path
    work: Path
    student: Settings
    device: DeviceName = "auto"  # that the student is trained on
    character: Path | None = None  # None: the procedural character
    motions: tuple[Path, ...] = ()  # none: the character's own clips
    face: Path | None = None  # facial motion for all clips; None: what the motion itself has
    hold_out: tuple[str, ...] = ()  # names of clips; none: the end of every clip
    mapping: Mapping[str, str] | None = None  # target joint to source joint
    feet: Feet = "auto"  # whether feet are held where the motion's feet stand
    motion_range: MotionRange = "full"  # whether a range of motion made for the rig is recorded too
    leave_out: tuple[str, ...] = ()  # meshes, nodes or materials of the file that are no part of the character
    alphas: Alphas = field(default_factory=dict)  # how materials are transparent, where the file is wrong
    expression_names: Mapping[str, str] | None = None  # what expressions of the file are to be called
    smplx: Path | None = None  # model of SMPL-X whose expressions the character gets
    uv: UvMode = "auto"
    detail: Detail = field(default_factory=dict)  # beyond what is finer by default
    size: FigureSize = AS_FOUND
    facing: Facing = AS_SHOWN
    storage: Storage = "f16"
    jobs: int = 1  # processes that record side by side
    teacher: Path | None = None  # that was trained on images; None: the simulated character
    training: TeacherSettings | None = None  # sets the teacher that is trained first on a capture
    clips: tuple[str, ...] = (ALL,)  # which the file holds for playback: names, or "all", "none" or a number

    def beside(self, ending: str) -> Path:
        """A file that lies beside the output and is named after it."""
        return self.output.with_name(self.output.stem + ending)
