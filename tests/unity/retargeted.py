"""What the package makes of another figure's poses as they come: rotations of its retargeting, hips that go as far."""

from collections.abc import Mapping

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.motion.contacts import floor_of, standing
from mua.motion.floor import foot_heights, hips_of, hips_path, led, leg_scale
from mua.motion.match import match_joints
from mua.motion.rest_alignment import Rest, Y, rest_of
from mua.motion.retarget import calibrations_at_rest, retarget
from mua.motion.source_motion import SourceMotion
from mua.pose.skeleton import Skeleton

SECONDS = 10  # that heights of feet are remembered


def expected(source: SourceMotion, target: Skeleton, mapping: Mapping[str, str] | None = None) -> tuple[Array, Array]:
    """The package's rotations, and translations that go as far as the source has gone since it was at rest."""
    matches = match_joints(source.skeleton, target, mapping, source_stated=source.stated)
    clip, _ = retarget(source, target, matches, rate=source.clip.rate)
    rest = rest_of(source.skeleton, target, matches)
    _, facing = calibrations_at_rest(rest)
    _, at = source.skeleton.world(source.clip.rotations, source.clip.translations)
    gone = rotation.rotate(facing, hips_path(rest, at) - hips_path(rest, rest.source_at[None]))
    path = rest.target_at[hips_of(rest)].mean(axis=0) + leg_scale(rest)[0] * gone
    translations = led(rest, clip.rotations, path)
    if floor_of(np.stack(list(rest.source_places().values()))) == 0:
        return clip.rotations, translations
    return clip.rotations, led(rest, clip.rotations, path + _lifts(rest, clip.rotations, translations, clip.rate) * Y)


def _lifts(rest: Rest, rotations: Array, translations: Array, rate: float) -> Array:
    """Metres [F, 1] by which each frame is raised: the lower foot stood on the floor in the seconds before it."""
    lower = foot_heights(rest, *rest.target.world(rotations, translations)).min(axis=1, keepdims=True)
    remembered = round(SECONDS * rate)
    return np.array([[-standing(lower[max(frame - remembered, 0) : max(frame, 1)])] for frame in range(len(lower))])
