"""An avatar in memory: exactly what a `.muaavatar` file holds (schemas/muaavatar.fbs), as numpy arrays.

The student exports one, the writer stores it, the reader returns it and the kernels decode it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from mua.arguments import amount, describe, finite_array, float_type, unit_quaternions, whole_number
from mua.arrays import Array
from mua.avatar.coarser import at_level, coarsest
from mua.avatar.decode import PoseWindow, Splats, decode, decode_clip_frame
from mua.avatar.model import Model
from mua.errors import InputError
from mua.limits import LARGEST_RATE, LEAST_RATE
from mua.pose.clip import Clip
from mua.pose.expression_names import set_weights
from mua.pose.resample import frames_at
from mua.pose.skeleton import Pose
from mua.rig.surface import Surface


@dataclass(frozen=True, eq=False, repr=False)
class Avatar(Model):
    """Everything that a player needs: what is decoded, clips to play, and what a person reads of it.

    `mua.load` gives one; `avatar.clips` are its motions, `avatar.rig.skeleton` its joints.
    """

    name: str
    producer: str  # program and version that trained it
    clips: tuple[Clip, ...]
    thumbnail: bytes  # PNG, may be empty
    notes: str  # e.g. that the teacher is a simulated stand-in
    surface: Surface | None = None  # triangles over the texels

    def decode(
        self,
        clip: str | Clip | Sequence[Pose],
        frame: int = 0,
        *,
        expressions: Mapping[str, float] | None = None,
        dtype: npt.DTypeLike = np.float32,
    ) -> Splats:
        """The splats of one frame, in world space, metres.

        `clip` is the name of one of the avatar's clips, a `Clip` of its skeleton at any rate, or a window of poses,
        newest first: as many as `avatar.encoding.window` says, `1 / avatar.encoding.rate` seconds apart. `frame` counts
        from 0 at the avatar's rate, `avatar.encoding.rate` frames per second; a window has no other frame than 0.
        `expressions` are weights by name, held to 0 to 1, in place of those of the clip or of the newest pose; what is
        not named is 0. `dtype` is float32 or float64. `outside` of the splats says how much of the pose training did
        not show, 0 to 1.

        Errors: InputError for a clip, a frame or an expression that is not there, and for poses of another skeleton's
        shape.

        Example:

            splats = avatar.decode("walk", 12)
            splats.centres.shape  # (number of splats, 3)
            avatar.decode("walk", 12, expressions={"jawOpen": 0.7})
        """
        number, element = whole_number(frame, "frame"), float_type(dtype, "dtype")
        named = None if expressions is None else self.weights(expressions)
        if isinstance(clip, str):
            clip = self.clip(clip)
        if isinstance(clip, Clip):
            clip = self._checked(clip, number)
            if named is not None:
                clip = replace(clip, expressions=np.broadcast_to(named, (len(clip), len(named))))
            return decode_clip_frame(self, clip, frame=number, dtype=element)
        if number != 0:
            raise InputError(f"frame is {number}; a window of poses has only frame 0")
        rotations, translations = self._window(clip)
        weights = self._pose_weights(clip[0].expressions) if named is None else named
        return decode(self, PoseWindow(rotations, translations, weights), dtype=element)

    @property
    def expressions(self) -> tuple[str, ...]:
        """The names of what moves its face besides joints; empty where it has none."""
        return () if self.rig.expressions is None else self.rig.expressions.names

    def weights(self, named: Mapping[str, float]) -> Array:
        """Weights [E] in the order of `expressions`, held to 0 to 1; 0 for those that nothing named moves.

        A name of ARKit, VRM or Oculus' visemes that the avatar does not have moves the nearest that it has.
        Errors: InputError for a name that moves nothing, and for a weight that is no finite number.
        """
        if not isinstance(named, Mapping):
            raise InputError(f"expressions is {describe(named)}; expected weights by name, such as {{'jawOpen': 0.7}}")
        for name, weight in named.items():
            finite_array(weight, f"weight of expression {name!r}", ())
            if not (isinstance(name, str) and set_weights(self.expressions, {name: 1.0})):
                held = ", ".join(self.expressions) or "none"
                raise InputError(f"expression is {describe(name)}; the avatar's expressions: {held}")
        followed = set_weights(self.expressions, named)
        return np.array([followed.get(name, 0.0) for name in self.expressions])

    def at_level(self, level: int) -> "Avatar":
        """The same avatar with fewer splats: the texture has half as many texels along a side, `level` times.

        0 is the avatar itself. Meant for decoding and drawing; a file holds the finest level alone.

        Errors: InputError for a level that the avatar does not have.

        Example:

            far = avatar.at_level(1)  # a quarter of the splats
        """
        number, most = whole_number(level, "level"), coarsest(self)
        if not 0 <= number <= most:
            raise InputError(f"level is {number}; the avatar has levels 0 to {most}")
        return self if number == 0 else replace(at_level(self, number), surface=None)

    def clip(self, name: str) -> Clip:
        """The clip of that name; raises InputError where there is none."""
        for clip in self.clips:
            if clip.name == name:
                return clip
        held = ", ".join(repr(clip.name) for clip in self.clips) or "no clips"
        raise InputError(f"clip is {describe(name)}; the avatar holds {held}")

    def __repr__(self) -> str:
        texels, joints = self.rig.texels, amount(len(self.rig.skeleton.names), "joint")
        return (
            f"<mua.Avatar {self.name!r}: {joints}, {len(self.rig.mesh.vertices):,} vertices, "
            f"{len(texels.texels):,} splats of {texels.size} x {texels.size} texels, {amount(len(self.clips), 'clip')}>"
        )

    def _checked(self, clip: Clip, frame: int) -> Clip:
        """The clip with quaternions of length 1."""
        joints, of = len(self.rig.skeleton.names), f"of clip {clip.name!r}"
        rotations = unit_quaternions(clip.rotations, f"rotations {of}", (None, joints, 4))
        finite_array(clip.translations, f"translations {of}", (len(rotations), joints, 3))
        if clip.expressions is not None:
            finite_array(clip.expressions, f"expressions {of}", (len(rotations), len(self.expressions)))
        if not len(clip):
            raise InputError(f"clip {clip.name!r} has no frames; expected at least one")
        if not LEAST_RATE <= finite_array(clip.rate, f"rate {of}", ()) <= LARGEST_RATE:
            raise InputError(f"rate {of} is {clip.rate}; expected {LEAST_RATE:g} to {LARGEST_RATE:g} frames per second")
        count = frames_at(clip, self.encoding.rate)
        if not 0 <= frame < count:
            raise InputError(f"frame is {frame}; clip {clip.name!r} has frames 0 to {count - 1}")
        return replace(clip, rotations=rotations)

    def _window(self, poses: Sequence[Pose]) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Rotations [k, J, 4] and translations [k, J, 3]."""
        if not isinstance(poses, Sequence) or not all(isinstance(pose, Pose) for pose in poses):
            raise InputError(f"clip is {describe(poses)}; expected a clip's name, a Clip or poses, newest first")
        if len(poses) != self.encoding.window:
            raise InputError(f"the window has {len(poses)} poses; expected {self.encoding.window}, newest first")
        joints = len(self.rig.skeleton.names)
        rotations = [unit_quaternions(pose.rotations, "rotations of a pose", (joints, 4)) for pose in poses]
        translations = [finite_array(pose.translations, "translations of a pose", (joints, 3)) for pose in poses]
        return np.stack(rotations), np.stack(translations)

    def _pose_weights(self, weights: Array | None) -> Array | None:
        if weights is None:
            return None
        return np.clip(finite_array(weights, "expressions of a pose", (len(self.expressions),)), 0, 1)
