"""Poses: the order of quaternions, whose rotations they are, the unit of translations, and where the root stands."""

from collections.abc import Iterator

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.pose.skeleton import Pose, Skeleton
from mua.recording.plausible.finding import Finding
from mua.recording.plausible.fit import explain, rms, unit_of

TURNED, CALM = np.radians(100), np.radians(50)  # a joint's median turn away from the bind pose, wrong and undone
OTHER_LENGTH = 10.0  # factor of a bone's length by which no animation stretches all bones
MOVED = 0.1  # share of the bones' lengths by which animation may change all joints' translations together
FAR, HIGH = 100.0, 20.0  # heights of the figure, or of a person, from the origin
PERSON = 1.75  # metres
FEW = 4  # joints; fewer prove nothing


class Poses:
    """Checks the poses of one skeleton."""

    def __init__(
        self,
        skeleton: Skeleton,
        size: float,  # size of the figure, metres
    ) -> None:
        self._skeleton, self._reach = skeleton, max(size, PERSON)
        self._path = [*reversed(skeleton.ancestors(skeleton.root)), skeleton.root]
        lengths = np.linalg.norm(skeleton.bind_translations, axis=1)
        on_body = (
            skeleton.root in skeleton.ancestors(joint) for joint in range(len(lengths))
        )  # controls stand beside it
        self._bones = np.flatnonzero((lengths > 0) & np.fromiter(on_body, bool, len(lengths)))
        self._place = self._root(skeleton.bind_pose)

    def __call__(self, pose: Pose) -> Iterator[Finding]:
        """Likely mistakes in a pose of the right shapes."""
        yield from self._rotations(pose.rotations)
        yield from self._bone_lengths(pose.translations)
        yield from self._standing(pose)

    def _rotations(self, given: Array) -> Iterator[Finding]:
        """Joints turn little from the bind pose: where half turn far, another convention may explain it."""
        turned = self._turn(given)
        if turned < TURNED or len(given) < FEW:
            return
        found = f"pose rotations turn half of all joints by {np.degrees(turned):.0f} degrees or more from the bind pose"
        if self._turn(np.roll(given, 1, axis=1)) < CALM:
            yield Finding(f"{found}, and by little if they are xyzw: are they? wxyz is expected", certain=True)
        elif self._turn(self._as_local(given)) < CALM:
            sentence = "are these rotations in the world? local ones, relative to the parent, are expected"
            yield Finding(f"{found}: {sentence}", certain=True)

    def _turn(self, rotations: Array) -> float:
        """The median angle of all joints away from the bind pose."""
        dot = np.abs(np.sum(rotations * self._skeleton.bind_rotations, axis=1))
        return float(np.median(2 * np.arccos(np.clip(dot, 0, 1))))

    def _as_local(self, world: Array) -> Array:
        parents = self._skeleton.parents
        above = np.where((parents >= 0)[:, None], world[parents], [1.0, 0, 0, 0])
        return rotation.multiply(rotation.conjugate(above), world)

    def _bone_lengths(self, given: Array) -> Iterator[Finding]:
        bones, bind = self._bones, self._skeleton.bind_translations
        if not len(bones):
            return
        own, expected = given[bones], bind[bones]
        if not own.any():
            sentence = "expected those of the bind pose for joints that only rotate (rig.skeleton.bind_translations)"
            yield Finding(f"pose translations are zero for all joints but the root, {sentence}", certain=True)
            return
        ratio = float(np.median(np.linalg.norm(own, axis=1) / np.linalg.norm(expected, axis=1)))
        moved = len(bones) >= FEW and rms(own - expected) > MOVED * rms(expected)
        mistake = explain(own, expected) if moved else None
        if mistake is not None or not 1 / OTHER_LENGTH < ratio < OTHER_LENGTH:
            found = f"pose translations make bones {ratio:.4g} times as long as in the bind pose and move them"
            yield Finding(f"{found}: {mistake.question if mistake else _question(ratio)}", certain=True)

    def _standing(self, pose: Pose) -> Iterator[Finding]:
        place = self._root(pose)
        away = np.abs(place - self._place)
        far, high = max(away[0], away[2]) > FAR * self._reach, away[1] > HIGH * self._reach
        if far or high:
            unit = "millimetres" if away.max() > FAR * self._reach else "centimetres"
            found = (
                f"pose puts the root joint at {_metres(place)}, where the bind pose has it at {_metres(self._place)}"
            )
            remedy = "metres are expected, and what happened far from the origin moved there"
            yield Finding(f"{found}: are these {unit}? {remedy}", certain=True)

    def _root(self, pose: Pose) -> Array:
        """Where the root joint is in the world [3]."""
        turned, place = np.array([1.0, 0, 0, 0]), np.zeros(3)
        for joint in self._path:
            place = place + rotation.rotate(turned, pose.translations[joint])
            turned = rotation.multiply(turned, pose.rotations[joint])
        return place


def _question(ratio: float) -> str:
    unit = unit_of(ratio)
    return f"are these {unit}? metres are expected" if unit else "metres are expected, from joint to joint"


def _metres(place: Array) -> str:
    return f"({', '.join(f'{value:.4g}' for value in place)}) m"
