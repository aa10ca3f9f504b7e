"""Whether what is called left is on the left: names may be swapped, bodies are not.

Feet point ahead, knees bend to the front and elbows to the back, animals carry their heads ahead of their hips, a face
is before the joint of its head, eyes are too and a tail is behind, and who goes far mostly goes ahead. Each of these is
measured against the direction that the names have for ahead: left x up.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from mua.arrays import Array
from mua.pose.joint_names import SIDES, Roles

NAMES = 1.0  # evidence that the names themselves are
FOOT = 0.1  # of a leg's length: how far a toe is ahead of the ankle; counts as much as the names
BEND = 0.05  # of a limb's length: how far a knee is ahead, or an elbow behind, of the line through the limb
FAR = 3.0  # lengths of the trunk that a path must have before its direction counts
STRAY = 0.1  # of a figure's size: how far eyes are ahead or a tail is behind
FACE = 0.05  # of a figure's size: how far the middle of a head is ahead of its joint, unless hair hangs behind it
HINT = 0.9  # that a head counts, which alone does not overrule the names
CERTAIN = 2.0  # evidence of a motion alone, whose rest pose may show anything, that overrules the names
MOST = 3.0  # that one kind of evidence counts
NARROW = 0.02  # of a trunk's length: joints of a pair that are nearer than this show no sides
LEVEL = 0.5  # cosine from upright: a trunk below it and legs above it are those of an animal, or of somebody who crawls
AHEAD = re.compile(r"eye(?!lash)|nose|jaw|mouth|snout|beak|tongue", re.IGNORECASE)
BEHIND = re.compile(r"tail(?!or)|abdomen|stinger", re.IGNORECASE)
Y = np.array([0.0, 1, 0])


@dataclass(frozen=True, eq=False)
class Figure:
    """Joints with what their names say they are, and where they stand."""

    names: Sequence[str]
    roles: Roles
    bind: Array  # [J, 3]
    clips: Sequence[Array] = ()  # [F, J, 3] each, at a steady rate
    surface: Array | None = None  # [J, 3] the middle of what each joint carries, NaN where it carries nothing


SWAPPED = (
    "The {}'s joints called left are on its right, by how its body is built and how it moves; left and right are "
    "exchanged."
)


def true_sides(names: Sequence[str], found: Roles, poses: Array) -> Roles:  # [P, J, 3]
    """The roles with left and right exchanged where a moving body shows that the names are swapped."""
    figure = Figure(names, found, poses[0], (poses,))
    body = _Body.of(figure, poses)
    return found if body is None or _moving([body]) > -CERTAIN else exchanged(found)


def evidence(figure: Figure, across: Array) -> float:
    """How much speaks for the names: below 0 the joints called left are on the right.

    `across` [3] leads from the joints called right to those called left in the bind pose.
    """
    bound = _Body.of(figure, figure.bind)
    found = NAMES + _clipped(_marks(figure, across) / STRAY) + np.clip(_face(figure, across) / FACE, -HINT, HINT)
    if bound is None:
        return found
    found += _clipped(_feet(figure, bound) / FOOT) + _clipped(_head(bound))
    bodies = [body for at in (figure.bind[None], *figure.clips) if (body := _Body.of(figure, at)) is not None]
    return found + _moving(bodies)


def _moving(bodies: "Sequence[_Body]") -> float:
    """The evidence of how limbs bend and of where the body goes."""
    legs, arms = (_mean([body.bend(*joints) for body in bodies]) for joints in (LEG, ARM))
    return _clipped(legs / BEND) - _clipped(arms / BEND) / 2 + _travel(bodies)


def exchanged(found: Roles) -> Roles:
    """Roles with left and right exchanged."""
    other = {"left": "right", "right": "left"}
    sides = {role: role.partition(" ") for role in found}
    return {f"{other[side]} {part}" if part else role: found[role] for role, (side, _, part) in sides.items()}


LEG, ARM = ("thigh", "shin", "foot"), ("upper_arm", "forearm", "hand")


@dataclass(frozen=True, eq=False)
class _Body:
    """A body in one pose or many: places of its roles, its trunk, and what its names have for ahead."""

    at: dict[str, Array]  # [..., 3] by role
    hips: Array  # [..., 3]
    top: Array  # [..., 3]
    ahead: Array  # [..., 3]
    level: bool  # whether the trunk is

    @classmethod
    def of(cls, figure: Figure, places: Array) -> "_Body | None":
        at = {role: places[..., joints[0], :] for role, joints in figure.roles.items()}
        pairs = {
            part: (at[f"left {part}"], at[f"right {part}"])
            for part in ("thigh", "shoulder", "upper_arm")
            if all(f"{side} {part}" in at for side in SIDES)
        }
        middles = {part: (left + right) / 2 for part, (left, right) in pairs.items()}
        hips = middles.get("thigh", at.get("hips"))
        top = at.get("neck", at.get("head", middles.get("upper_arm")))
        if hips is None or top is None:
            return None
        narrow = NARROW * np.linalg.norm(top - hips, axis=-1).mean()
        lines = [left - right for left, right in pairs.values()]
        wide = [_unit(line) for line in lines if np.linalg.norm(line, axis=-1).mean() > narrow]
        if not wide:
            return None
        across = _unit(np.sum(wide, axis=0))
        up = _unit(top - hips)
        level = bool(abs(np.median(up[..., 1])) < LEVEL) and _hang(at)
        return cls(at, hips, top, _unit(np.cross(across, Y if level else up)), level)

    def bend(self, begin: str, middle: str, end: str) -> float | None:
        """How far knees or elbows are ahead of the line through their limbs, of these' lengths, on average."""
        shares = []
        for side in SIDES:
            joints = [self.at.get(f"{side} {part}") for part in (begin, middle, end)]
            first, bent, last = joints
            if first is None or bent is None or last is None:
                continue
            along, out = _unit(last - first), bent - first
            out = out - np.sum(out * along, axis=-1, keepdims=True) * along
            length = np.linalg.norm(bent - first, axis=-1) + np.linalg.norm(last - bent, axis=-1)
            shares.append(float(np.mean(np.sum(out * self.ahead, axis=-1) / np.where(length > 0, length, 1))))
        return float(np.mean(shares)) if shares else None


def _hang(at: Mapping[str, Array]) -> bool:
    """Whether legs point down, as those of an animal do; those of a person who lies go on where the trunk ends."""
    pairs = [(at.get(f"{side} thigh"), at.get(f"{side} foot")) for side in SIDES]
    legs = [_unit(foot - thigh) for thigh, foot in pairs if thigh is not None and foot is not None]
    return not legs or bool(np.median(legs, axis=0)[..., 1].mean() < -LEVEL)


def _feet(figure: Figure, body: _Body) -> float:
    """How far toes, or what feet carry, are ahead of the ankles, of a leg's length."""
    found = []
    for side in SIDES:
        thigh, ankle, toe = (body.at.get(f"{side} {part}") for part in ("thigh", "foot", "toe"))
        if ankle is None or thigh is None:
            continue
        if toe is None and figure.surface is not None:
            toe = figure.surface[figure.roles[f"{side} foot"][0]]
        if toe is not None and np.isfinite(toe).all():
            found.append(float((toe - ankle) @ body.ahead / max(np.linalg.norm(ankle - thigh), 1e-9)))
    return 0.0 if body.level else _mean(found)


def _head(body: _Body) -> float:
    """Evidence of a trunk that lies level: its upper end is ahead."""
    return float(MOST * _unit(body.top - body.hips) @ body.ahead) if body.level else 0.0


def _face(figure: Figure, across: Array) -> float:
    """How far what the head carries is ahead of its joint, of the figure's size."""
    heads = list(figure.roles.get("head", ()))[:1]
    if not heads or figure.surface is None or not np.isfinite(figure.surface[heads]).all():
        return 0.0
    size = float(np.ptp(figure.bind, axis=0).max()) or 1.0
    return float((figure.surface[heads] - figure.bind[heads])[0] @ _unit(np.cross(across, Y))) / size


def _marks(figure: Figure, across: Array) -> float:
    """How far eyes are ahead of the joints' middle and that of tails behind it, of the figure's size."""
    ahead = _unit(np.cross(across, Y))
    along = figure.bind @ ahead
    size = float(np.ptp(figure.bind, axis=0).max()) or 1.0
    found = []
    for marked, way in ((AHEAD, 1), (BEHIND, -1)):
        joints = [joint for joint, name in enumerate(figure.names) if marked.search(name)]
        if joints:
            base = figure.roles["head"][0] if way > 0 and "head" in figure.roles else None
            start = along.mean() if base is None else along[base]
            found.append(way * float(along[joints].mean() - start) / size)
    return _mean(found)


def _travel(bodies: Sequence[_Body]) -> float:
    """Evidence of who goes far: -1..1."""
    along = path = 0.0
    for body in bodies:
        if body.hips.ndim == 2 and len(body.hips) > 1:
            steps = np.diff(body.hips, axis=0) * [1, 0, 1] / np.linalg.norm(body.top - body.hips, axis=-1).mean()
            along += float(np.sum(steps * body.ahead[:-1]))
            path += float(np.linalg.norm(steps, axis=-1).sum())
    return along / path if path > FAR else 0.0


def _mean(values: Sequence[float | None]) -> float:
    known = [value for value in values if value is not None]
    return float(np.mean(known)) if known else 0.0


def _clipped(value: float) -> float:
    return float(np.clip(value, -MOST, MOST))


def _unit(v: Array) -> Array:
    length = np.linalg.norm(v, axis=-1, keepdims=True)
    return np.asarray(v / np.where(length > 0, length, 1))
