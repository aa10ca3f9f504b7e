"""Where the head looks and how the hands are turned, on a character and in its motion."""

from collections.abc import Mapping

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.motion.pair import Pair, Side
from mua.motion.trunk import SIDES, degrees, nearest_axis, trunk_of, unit

UPRIGHT = 60.0  # degrees from upright up to which a body holds its head against it
UPWARD = 25.0  # degrees above the horizon at which nobody looks for half of a clip
DOWNWARD = 60.0  # degrees below it
OTHERWISE = 20.0  # degrees by which the head may look higher or lower than in the motion
HAND_BOUND = 35.0  # degrees of a hand's median from which a sentence says so
Y = np.array([0.0, 1, 0])


def head_pitch(pair: Pair) -> tuple[float | None, float | None]:
    """Median degrees above the horizon at which the heads of target and source look while the body is upright.

    None where nothing moves the head, nobody is upright, or the source's rest pose does not show its front.
    """
    trunk = pair.target.trunk()
    upright = np.array([False]) if trunk is None else trunk.up[:, 1] > np.cos(np.radians(UPRIGHT))
    if not upright.any():
        return None, None
    sides = ((pair.target, pair.head), (pair.source, pair.source_head))
    target, source = (_pitch(side, turned, upright) if side.trusted else None for side, turned in sides)
    return target, source


def _pitch(side: Side, turned: Array | None, upright: Array) -> float | None:
    trunk = trunk_of(side.rest())
    if turned is None or trunk is None:
        return None
    ahead = unit(np.cross(trunk.hips, nearest_axis(trunk.up)))
    looks = rotation.rotate(turned, ahead)[upright]
    return float(np.median(np.degrees(np.arcsin(np.clip(looks[:, 1], -1, 1)))))


def hand_angles(pair: Pair, heading: Array) -> dict[str, float]:
    """By hand, degrees between where palms or fingers point, whichever differ more: the median over frames.

    The source is turned by `heading` [4] about Y. Hands whose fingers only one side has are left out.
    """
    target, source = _hands(pair.target), _hands(pair.source)
    return {
        hand: max(
            float(np.median(degrees(ours, rotation.rotate(heading, theirs))))
            for ours, theirs in zip(target[hand], source[hand], strict=True)
        )
        for hand in target
        if hand in source
    }


def _hands(side: Side) -> dict[str, tuple[Array, Array]]:
    """By hand, where its fingers point and where its palm does [F, 3]."""
    found = {}
    for name in SIDES:
        wrist, index, middle, pinky = (side.place(f"{name} {part}") for part in ("hand", "index", "middle", "pinky"))
        if wrist is not None and index is not None and middle is not None and pinky is not None:
            fingers = unit(middle - wrist)
            palm = unit(np.cross(index - pinky, fingers))
            if fingers.any() and palm.any():
                found[f"{name} hand"] = fingers, palm
    return found


def head_flaws(name: str, pitch: float | None, source: float | None) -> list[str]:
    """A sentence where a head looks where nobody does, or elsewhere than in the motion."""
    if pitch is None:
        return []
    seen = f"{name}: the head looks {abs(pitch):.0f} degrees {'upward' if pitch > 0 else 'downward'}"
    if source is not None:
        other = f"{abs(source):.0f} degrees {'upward' if source > 0 else 'downward'}"
        return [f"{seen}; in the motion {other}."] if abs(pitch - source) > OTHERWISE else []
    return [f"{seen} in half of the frames."] if pitch > UPWARD or pitch < -DOWNWARD else []


def hand_flaws(name: str, hands: Mapping[str, float]) -> list[str]:
    """A sentence on the hands that are turned otherwise than in the motion."""
    wrong = ", ".join(f"{hand} {angle:.0f}" for hand, angle in hands.items() if angle > HAND_BOUND)
    return [f"{name}: hands are turned otherwise than in the motion (degrees: {wrong})."] if wrong else []
