"""Put frames of a sender onto an avatar, by the code that retargets clips.

What a clip's retargeting learns from all of its frames is here known of the protocol or learnt on the way: joints are
calibrated by the rest pose, which is that of VRM 0; the path of the hips is scaled by the legs alone; and the height
follows the feet, whose lower one stood on the floor in the last SECONDS.
"""

from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TypeAlias

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.errors import InputError
from mua.live.bones import AT_EASE, AT_REST, BONES, PLACES, ROOT, sender_skeleton
from mua.live.vmc import Frame
from mua.motion.contacts import standing
from mua.motion.floor import foot_heights, hips_of, hips_path, led, leg_scale
from mua.motion.match import match_joints, missing_limbs
from mua.motion.rest_alignment import Rest, Y, rest_of
from mua.motion.retarget import calibrations_at_rest, local_rotations
from mua.pose.descriptor import heading_of
from mua.pose.skeleton import Pose, Skeleton

SECONDS = 10.0
MOST_HEIGHTS = 600  # that are remembered: of 60 frames a second
OTHER = 0.005  # metres by which the bones of another figure differ
MOVING = [BONES.index(ROOT), BONES.index("Hips")]  # bones whose places say how the figure goes
CONFIRMED = 30  # frames in a row that show another figure before its bones are taken: one that is wrong changes nothing

Heights: TypeAlias = deque[tuple[float, float]]  # times, and how high the lower foot was above the floor, metres


@dataclass(eq=False)
class _Sender:
    """How one figure of a sender moves the avatar."""

    present: Array  # [S] indices of BONES
    known: Array  # [B] bool
    offsets: Array  # [B, 3] metres
    rest: Rest
    calibrations: Mapping[int, Array]
    facing: Array  # [4]
    scale: float  # avatar over sender
    heights: Heights = field(default_factory=lambda: deque(maxlen=MOST_HEIGHTS))
    other: Array | None = None  # [B, 3] offsets of another figure, which may have taken its place
    seen: int = 0  # frames in a row that show that one


class Posing:
    """Poses an avatar as a sender's figure; frames are given in the order of their times."""

    def __init__(self, skeleton: Skeleton, mapping: Mapping[str, str] | None = None) -> None:
        """`mapping` gives, for joints of the avatar, the bone that moves them; others are matched by their names.

        Errors: InputError where it names a joint or bone that there is none of, or where no bone moves an arm or leg.
        """
        self._skeleton, self._mapping = skeleton, mapping or {}
        whole, _ = sender_skeleton(np.ones(len(BONES), bool), np.zeros_like(PLACES))
        matches = match_joints(whole, skeleton, mapping)
        if not mapping and (missing := missing_limbs(whole, skeleton, matches)):
            raise InputError(
                f"no bone of VMC is known to move its {' and '.join(missing)}; give for its joints such bones as "
                "LeftUpperArm in a JSON file with --mapping",
                f"joints: {', '.join(skeleton.names)}\nbones: {', '.join(BONES)}",
            )
        nothing = np.zeros(len(BONES), bool)
        self._sender = self._learn(nothing, np.zeros_like(PLACES))
        self.at_ease = self.settled(Frame(0.0, AT_REST, np.zeros_like(PLACES), nothing, {}))  # before any frame

    def pose(self, frame: Frame) -> Pose:
        """The avatar's pose for a frame; bones that are not sent are at ease."""
        sender = self._follow(frame)
        return self._posed(sender, frame, sender.heights)

    def settled(self, frame: Frame) -> Pose:
        """At ease where a frame has the avatar, and turned about the vertical as it is there."""
        rotations, known = AT_REST.copy(), np.zeros(len(BONES), bool)
        rotations[MOVING], known[MOVING] = heading_of(frame.rotations[MOVING]), frame.known[MOVING]
        return self._posed(self._sender, replace(frame, rotations=rotations, known=known), deque())

    def _posed(self, sender: _Sender, frame: Frame, heights: Heights) -> Pose:
        joints, figure = sender.present, sender.rest.source
        rotations = np.where(frame.known[joints, None], frame.rotations[joints], AT_EASE[joints])
        translations = figure.bind_translations.copy()
        for moving in (0, figure.root):
            if frame.known[joints[moving]]:
                translations[moving] = frame.positions[joints[moving]]
        turned, at = figure.world(rotations[None], translations[None])
        local = local_rotations(sender.rest, sender.calibrations, rotation.multiply(sender.facing, turned))
        if not hips_of(sender.rest):
            return Pose(local[0], self._skeleton.bind_translations)
        path = sender.scale * hips_path(sender.rest, rotation.rotate(sender.facing, at))
        return Pose(local[0], self._on_floor(sender.rest, local, path, frame.time, heights)[0])

    def _on_floor(self, rest: Rest, rotations: Array, path: Array, time: float, heights: Heights) -> Array:
        """Local translations [1, J, 3] with the hips on a path [1, 3] over the floor on which the feet stand."""
        known = bool(heights)
        lift = self._lift(heights, time)
        translations = led(rest, rotations, path + lift * Y)
        turned, at = self._skeleton.world(rotations, translations)
        heights.append((time, float(foot_heights(rest, turned, at).min()) - lift))
        return translations if known else led(rest, rotations, path + self._lift(heights, time) * Y)

    def _lift(self, heights: Heights, time: float) -> float:
        while heights and heights[0][0] < time - SECONDS:
            heights.popleft()
        return -standing(np.array([[height] for _, height in heights])) if heights else 0.0

    def _follow(self, frame: Frame) -> _Sender:
        """The sender of a frame: the one known, unless its figure has changed for good."""
        sender = self._sender
        if _alike(frame.positions, sender.offsets):
            sender.other, sender.seen = None, 0
        elif sender.other is not None and _alike(frame.positions, sender.other):
            sender.seen += 1
        else:
            sender.other, sender.seen = frame.positions, 1
        if sender.seen >= CONFIRMED or (frame.known & ~sender.known).any():
            self._sender = self._learn(frame.known, frame.positions)
        return self._sender

    def _learn(self, known: Array, offsets: Array) -> _Sender:
        figure, present = sender_skeleton(known, offsets)
        mapping = {joint: bone for joint, bone in self._mapping.items() if bone in figure.names}
        matches = match_joints(figure, self._skeleton, mapping)
        rest = rest_of(figure, self._skeleton, matches)
        calibrations, facing = calibrations_at_rest(rest)
        return _Sender(present, known, offsets, rest, calibrations, facing, leg_scale(rest)[0])


def _alike(a: Array, b: Array) -> bool:
    """Whether offsets [B, 3] are of one figure."""
    apart = np.abs(a - b).max(axis=-1)
    apart[MOVING] = 0
    return bool((apart <= OTHER).all())
