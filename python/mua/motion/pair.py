"""A clip on a character beside the motion that it was made from, frame by frame in the world."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.motion.match import Matches
from mua.motion.source_motion import SourceMotion
from mua.motion.trunk import AT_EASE, SIDES, Trunk, lean_of, leaned, on_all_fours, stands, trunk_of
from mua.pose.clip import Clip
from mua.pose.resample import resample
from mua.pose.skeleton import Skeleton


@dataclass(frozen=True, eq=False)
class Side:
    """One of two skeletons: places [..., J, 3] of its joints in metres, and which joint begins a role."""

    at: Array  # [F, J, 3]
    rest_at: Array  # [J, 3] in the bind pose
    roles: Mapping[str, int]  # only those matched
    trusted: bool  # whether the bind pose shows how the trunk stands

    def place(self, role: str) -> Array | None:
        """[F, 3] where a role begins."""
        return self.at[:, self.roles[role]] if role in self.roles else None

    def rest(self) -> dict[str, Array]:
        """[3] by role."""
        return {role: self.rest_at[joint] for role, joint in self.roles.items()}

    def trunk(self) -> Trunk | None:
        """Up of the trunk as upright as its bind pose is, and left, [F, 3] each."""
        found = trunk_of({role: self.at[:, joint] for role, joint in self.roles.items()})
        if found is None:
            return None
        at_rest = trunk_of(self.rest()) if self.trusted else None
        lean = -AT_EASE if at_rest is None else lean_of(at_rest)
        return Trunk(leaned(found, -lean), found.hips, found.chest)

    def hips(self) -> Array | None:
        """[F, 3] the middle between the legs."""
        left, right = (self.place(f"{side} thigh") for side in SIDES)
        return self.place("hips") if left is None or right is None else (left + right) / 2

    @property
    def leg(self) -> float:
        """Metres of a leg; half the height of a body without legs."""
        chain = [place for part in ("thigh", "shin", "foot") if (place := self.place(f"left {part}")) is not None]
        length = float(np.linalg.norm(np.diff(chain, axis=0), axis=-1).sum(axis=0).mean()) if len(chain) == 3 else 0.0
        return length or float(np.ptp(self.rest_at[:, 1])) / 2 or 1.0

    def soles(self) -> list[int]:
        """The joint nearest to the floor of each foot."""
        found = [self.roles.get(f"{side} toe", self.roles.get(f"{side} foot")) for side in SIDES]
        return [joint for joint in found if joint is not None]


@dataclass(frozen=True, eq=False)
class Pair:
    """Both skeletons over the same frames."""

    target: Side
    source: Side
    rate: float
    turned: Mapping[str, Array]  # [F, 4] what the clip does since bind to the last joint of the target's hips and spine
    head: Array | None  # [F, 4] the same of the target's head, None where nothing moves it
    source_head: Array | None  # [F, 4] what the motion does to the head since its rest pose

    @classmethod
    def of(cls, source: SourceMotion, target: Skeleton, clip: Clip, matches: Matches) -> "Pair":
        original = resample(source.clip, clip.rate)
        frames = min(len(clip), len(original))
        turned, at = target.world(clip.rotations[:frames], clip.translations[:frames])
        source_turned, source_at = source.skeleton.world(original.rotations[:frames], original.translations[:frames])
        bind_turned, bind_at = _bind(target)
        ends = {role: pair for role in matches.roles if (pair := matches.ends(role)) is not None}
        last = {role: joints[-1] for role in ("hips", "spine") if (joints := matches.roles.get(role))}
        source_bind_turned, source_bind = _bind(source.skeleton)
        head, source_head = ends.get("head", (None, None))
        sources = {role: joint for role, (_, joint) in ends.items()}
        source_rest = {role: source_bind[joint] for role, joint in sources.items()}
        return cls(
            Side(at, bind_at, {role: joint for role, (joint, _) in ends.items()}, trusted=True),
            Side(source_at, source_bind, sources, trusted=stands(source_rest) or on_all_fours(source_rest)),
            clip.rate,
            {role: _since(turned, bind_turned, joint) for role, joint in last.items() if joint in matches.chains},
            None if head is None else _since(turned, bind_turned, head),
            None if source_head is None else _since(source_turned, source_bind_turned, source_head),
        )


def _since(turned: Array, bind: Array, joint: int) -> Array:
    """What a joint has turned [F, 4] since the bind pose."""
    return rotation.multiply(turned[:, joint], rotation.conjugate(bind[joint]))


def _bind(skeleton: Skeleton) -> tuple[Array, Array]:
    return skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
