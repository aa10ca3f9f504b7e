"""What the package makes of another figure's poses as they come: rotations of its retargeting, hips that go as far."""

from collections.abc import Mapping

from mua import rotation
from mua.arrays import Array
from mua.motion.floor import hips_of, hips_path, led, leg_scale
from mua.motion.match import match_joints
from mua.motion.rest import rest_of
from mua.motion.retarget import calibrations_at_rest, retarget
from mua.motion.source import SourceMotion
from mua.pose.skeleton import Skeleton


def expected(source: SourceMotion, target: Skeleton, mapping: Mapping[str, str] | None = None) -> tuple[Array, Array]:
    """The package's rotations, and translations that go as far as the source has gone since it was at rest."""
    matches = match_joints(source.skeleton, target, mapping, source_stated=source.stated)
    clip, _ = retarget(source, target, matches, rate=source.clip.rate)
    rest = rest_of(source.skeleton, target, matches)
    _, facing = calibrations_at_rest(rest)
    _, at = source.skeleton.world(source.clip.rotations, source.clip.translations)
    gone = rotation.rotate(facing, hips_path(rest, at) - hips_path(rest, rest.source_at[None]))
    start = rest.target_at[hips_of(rest)].mean(axis=0)
    return clip.rotations, led(rest, clip.rotations, start + leg_scale(rest)[0] * gone)
