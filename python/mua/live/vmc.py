"""Frames of a VMC stream: whole poses of the sender's figure, put together from the messages of many packets.

A frame may be split over packets. It is complete at /VMC/Ext/Blend/Apply, /VMC/Ext/OK and /VMC/Ext/T, with which
senders begin or end one; where a bone comes a second time; and when the display asks for it after QUIET seconds without
a message. Bones and expressions that a frame lacks keep what they had; after GONE seconds without a frame all are
forgotten.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from mua.arrays import Array
from mua.live.bones import AT_REST, BONES, INDEX, ROOT
from mua.live.osc import Argument, MalformedError, Message, messages

QUIET = 0.004  # seconds; the packets of one frame come within less
GONE = 1.0  # seconds without a frame after which a sender has stopped
LONGEST_NAME = 64  # characters of an expression
MOST_EXPRESSIONS = 256
FARTHEST = 1e3  # metres
SHORTEST = 1e-3  # length of a quaternion below which it says nothing

BONE, PLACE = "/VMC/Ext/Bone/Pos", "/VMC/Ext/Root/Pos"
WEIGHT = "/VMC/Ext/Blend/Val"
COMPLETE = ("/VMC/Ext/Blend/Apply", "/VMC/Ext/OK", "/VMC/Ext/T")

_Placed: TypeAlias = tuple[tuple[float, ...], tuple[float, ...]]  # position, rotation


@dataclass(frozen=True, eq=False)
class Frame:
    """A whole pose of the sender's figure, in axes as ours: Y up, right-handed, the figure's left at +X."""

    time: float  # seconds by the clock of Assembler; when its last packet came
    rotations: Array  # [B, 4] of BONES in their parents, wxyz
    positions: Array  # [B, 3] metres in their parents; 0 where they are left out
    known: Array  # [B] bool, whether the bone is sent
    expressions: Mapping[str, float]  # weight by name, 0 to 1


@dataclass
class Counts:
    """What has come so far."""

    packets: int = 0
    malformed: int = 0  # packets that are no OSC, which are dropped
    ignored: int = 0  # messages of VMC with values that mean nothing: NaN, no such bone, a name that is too long
    frames: int = 0


class Assembler:
    """Takes packets in the order in which they come and keeps the newest frame; its memory is bounded."""

    def __init__(self) -> None:
        self.counts = Counts()
        self.newest: Frame | None = None
        self._time = 0.0  # of the last part of a frame
        self._bones: dict[int, _Placed] = {}  # of the frame that is coming
        self._weights: dict[str, float] = {}

    def feed(self, packet: bytes, time: float) -> None:
        """Take a packet that came at a time, seconds; one that is malformed changes nothing but the counts."""
        self.counts.packets += 1
        try:
            found = list(messages(packet))
        except MalformedError:
            self.counts.malformed += 1
            return
        for message in found:
            if not self._take(message, time):
                self.counts.ignored += 1

    def settle(self, time: float) -> None:
        """Complete the frame whose last part came QUIET seconds ago."""
        if time - self._time >= QUIET:
            self._complete()

    def _take(self, message: Message, time: float) -> bool:
        """Whether a message means something; those that are no part of a pose do nothing."""
        address, arguments = message
        if address in COMPLETE:
            self._complete()
        elif address in (BONE, PLACE):
            name = arguments[0] if arguments and isinstance(arguments[0], str) else ""
            return self._place(INDEX.get(ROOT.lower() if address == PLACE else name.lower()), arguments[1:8], time)
        elif address == WEIGHT:
            return len(arguments) >= 2 and self._weigh(arguments[0], arguments[1], time)
        return True

    def _place(self, bone: int | None, numbers: tuple[Argument, ...], time: float) -> bool:
        """Take position and rotation of a bone; VMC 2.1 has more of the root, for mixed reality."""
        if bone is None or len(numbers) < 7:
            return False
        x, y, z, *turn = (float(number) if isinstance(number, int | float) else math.nan for number in numbers)
        length = math.hypot(*turn)
        if not (abs(x) <= FARTHEST and abs(y) <= FARTHEST and abs(z) <= FARTHEST and SHORTEST < length < math.inf):
            return False
        if bone in self._bones and BONES[bone] != ROOT:  # some repeat the root in every packet of a frame
            self._complete()
        qx, qy, qz, qw = (part / length for part in turn)
        self._bones[bone] = (-x, y, z), (qw, qx, -qy, -qz)  # Unity's axes, mirrored in X
        self._time = time
        return True

    def _weigh(self, name: Argument, weight: Argument, time: float) -> bool:
        """Take the weight of an expression."""
        if not isinstance(name, str) or not isinstance(weight, int | float) or not math.isfinite(weight):
            return False
        before = {} if self.newest is None else self.newest.expressions
        room = 0 < len(name) <= LONGEST_NAME and len(before) + len(self._weights) < MOST_EXPRESSIONS
        if not room and name not in before and name not in self._weights:
            return False
        self._weights[name] = min(max(float(weight), 0.0), 1.0)
        self._time = time
        return True

    def _complete(self) -> None:
        """Make what has come, if anything, the newest frame."""
        if not (self._bones or self._weights):
            return
        before = self.newest
        if before is None or self._time - before.time > GONE:
            before = Frame(0.0, AT_REST, np.zeros((len(BONES), 3)), np.zeros(len(BONES), bool), {})
        rotations, positions, known = before.rotations.copy(), before.positions.copy(), before.known.copy()
        if moved := list(self._bones):
            positions[moved], rotations[moved] = (np.array(parts) for parts in zip(*self._bones.values(), strict=True))
            known[moved] = True
        self.newest = Frame(self._time, rotations, positions, known, {**before.expressions, **self._weights})
        self.counts.frames += 1
        self._bones, self._weights = {}, {}
