"""The pose that an avatar has now, as another program sends it: eased in and out, with the window of its descriptor.

An avatar stands at ease until a sender begins, and again, where it is, when the sender has stopped: GONE seconds after
its last frame. From one to the other it takes EASING seconds, so that nothing jumps. While a frame is late, the last
one stays.
"""

import math
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from threading import Lock

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.live.retargeting import Posing
from mua.live.vmc import GONE, Frame
from mua.pose.encoding import PoseEncoding
from mua.pose.expression_names import match_expressions
from mua.pose.skeleton import Pose, Skeleton

EASING = 0.5  # seconds
MOST_POSES = 64  # of the past: a window of 67 ms at 240 pictures a second, four times


@dataclass(frozen=True, eq=False)
class LivePose:
    """A pose, with the weights of the avatar's expressions where it has any."""

    pose: Pose
    expressions: Mapping[str, float] = field(default_factory=dict)  # as the sender names them, 0 to 1


class Live:
    """What an avatar does that follows a sender; several threads may ask."""

    def __init__(
        self,
        newest: Callable[[float], Frame | None],  # the newest frame at a time of time.monotonic(), as Receiver.newest
        skeleton: Skeleton,
        encoding: PoseEncoding,
        *,
        mapping: Mapping[str, str] | None = None,  # avatar's joint to bone of BONES
        expressions: Sequence[str] = (),  # names of the avatar's
    ) -> None:
        """Errors: InputError where no bone moves an arm or leg, or `mapping` names a joint or bone there is none of."""
        self._posing, self._face = Posing(skeleton, mapping), _Face(expressions)
        self._newest, self._encoding, self._lock = newest, encoding, Lock()
        self.at_ease = self.now = LivePose(self._face.on(self._posing.at_ease, {}))
        self.moment = 0  # tells poses apart: another one has another
        self.arrived: float | None = None  # when the last packet of the pose came; None while it is of no packet
        self._frame: Frame | None = None
        self._goal = self._begin = self.at_ease  # what it eases to, and from
        self._since = self._before = -math.inf  # when it began to, and when `advance` was last called
        self._past: deque[tuple[float, Pose]] = deque([(0.0, self.now.pose)], MOST_POSES)

    def advance(self, time: float) -> LivePose:
        """The pose at a time of time.monotonic(), seconds, which must not be earlier than the last one."""
        with self._lock:
            frame = self._newest(time)
            if frame is not None and time - frame.time >= GONE:
                frame = None
            if (frame is None) != (self._frame is None) or time - self._before > GONE:
                self._begin, self._since = self.now, time
            if frame is not self._frame:
                self._goal = self._goal_of(frame)
            self._frame, self._before = frame, time
            self.arrived = None if frame is None else frame.time
            share = min((time - self._since) / EASING, 1.0)
            eased = self._goal if share == 1 else _between(self._begin, self._goal, share * share * (3 - 2 * share))
            self._show(eased, time if share < 1 or frame is None else frame.time)
            return self.now

    def window(self) -> tuple[Array, Array]:
        """Local rotations [k, J, 4] and translations [k, J, 3] at the avatar's rate, newest first."""
        with self._lock:
            newest = self._past[-1][0]
            poses = [self._at(newest - age / self._encoding.rate) for age in range(self._encoding.window)]
        return np.stack([pose.rotations for pose in poses]), np.stack([pose.translations for pose in poses])

    def _goal_of(self, frame: Frame | None) -> LivePose:
        """The pose of a frame, or at ease where the last one left the avatar."""
        if frame is not None:
            return LivePose(self._face.on(self._posing.pose(frame), frame.expressions), frame.expressions)
        if self._frame is None:
            return self.at_ease
        return LivePose(self._face.on(self._posing.settled(self._frame), {}))

    def _show(self, shown: LivePose, time: float) -> None:
        """Show another pose, of this time."""
        if shown is not self.now:
            self.now, self.moment = shown, self.moment + 1
            self._past.append((max(time, self._past[-1][0]), shown.pose))

    def _at(self, time: float) -> Pose:
        """The pose that was shown at a time; before the first that is remembered, that one."""
        later = self._past[-1]
        for earlier in reversed(self._past):
            if earlier[0] <= time:
                apart = later[0] - earlier[0]
                return _mixed(earlier[1], later[1], (time - earlier[0]) / apart if apart > 0 else 0.0)
            later = earlier
        return later[1]


class _Face:
    """Gives poses the weights of an avatar's expressions, whatever the sender calls them."""

    def __init__(self, names: Sequence[str]) -> None:
        self._names = names
        self._sent: tuple[str, ...] = ()
        self._shares = match_expressions(names, ())  # [E, S]

    def on(self, pose: Pose, sent: Mapping[str, float]) -> Pose:
        """The pose with weights [E] for those of a sender."""
        if not self._names:
            return pose
        if tuple(sent) != self._sent:
            self._sent = tuple(sent)
            self._shares = match_expressions(self._names, self._sent)
        return replace(pose, expressions=np.clip(self._shares @ np.array([*sent.values()], float), 0, 1))


def _between(a: LivePose, b: LivePose, share: float) -> LivePose:
    """From one pose to another at a share of 0 to 1; an expression that one lacks has the weight 0 there."""
    names = [*a.expressions, *(name for name in b.expressions if name not in a.expressions)]
    weights = {
        name: (1 - share) * a.expressions.get(name, 0.0) + share * b.expressions.get(name, 0.0) for name in names
    }
    return LivePose(_mixed(a.pose, b.pose, share), weights)


def _mixed(a: Pose, b: Pose, share: float) -> Pose:
    if share in (0.0, 1.0):
        return b if share else a
    turned = rotation.slerp(a.rotations, b.rotations, np.full(len(a.rotations), share))
    weights = None
    if a.expressions is not None and b.expressions is not None:
        weights = (1 - share) * a.expressions + share * b.expressions
    return Pose(turned, (1 - share) * a.translations + share * b.translations, weights)
