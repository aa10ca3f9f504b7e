"""Poses of a template from 3D keypoints: joint angles, a path of the hips, and lengths of limbs.

Damped least squares over all joint angles of a frame (Levenberg 1944, https://doi.org/10.1090/qam/10666), begun at the
frame before. What keypoints do not show, such as how a forearm is twisted, stays near the bind pose.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.atlas.character_surfaces import Surfaces
from mua.capture.keypoint_targets import Target, find_targets, limb_scales, well_seen
from mua.capture.readers.keypoints import Keypoints
from mua.pose.clip import Clip
from mua.pose.skeleton import Skeleton

STEPS = 30  # of each frame at most
FIRST_STEPS = 200  # of the first frame, which begins at the bind pose
ENOUGH = 1e-7  # of the error, by which a further step improves it
AT_REST = 0.02  # metres of distance that weigh as much as a joint that turns by one radian from its bind pose


@dataclass(frozen=True, eq=False)
class Fitted:
    """Poses, and how far they are from the keypoints."""

    clip: Clip
    targets: tuple[Target, ...]
    distances: Array  # [F, K] metres, not finite where a keypoint was not seen
    limbs: float  # how many times as long as the template's the person's are, all together

    def spread(self) -> list[tuple[float, float]]:
        """The median and the largest distance of every keypoint, metres."""
        seen = (distances[np.isfinite(distances)] for distances in self.distances.T)
        return [(float(np.median(one)), float(one.max())) for one in seen]


def fit_keypoints(keypoints: Keypoints, surfaces: Surfaces) -> Fitted:
    """The poses of a template that bring it nearest to keypoints.

    Limbs become as long as the person's, the same in all frames. Errors: InputError where too few keypoints have names
    of body parts, or the template has no joints for them.
    """
    skeleton = surfaces.skeleton
    targets = find_targets(keypoints, surfaces)
    points = keypoints.points[:, [target.keypoint for target in targets]]
    lengths, limbs = limb_scales(skeleton, targets, points)
    solver = _Solver(skeleton, targets, skeleton.bind_translations * lengths[:, None])
    rotations, translations = solver.start(points[well_seen(keypoints, targets)])
    poses, distances = [], []
    for number, frame in enumerate(points):
        rotations, translations = solver.solve(rotations, translations, frame, STEPS if number else FIRST_STEPS)
        poses.append((rotations, translations))
        distances.append(np.linalg.norm(solver.places(rotations, translations)[0] - frame, axis=1))
    turned, moved = (np.stack(values) for values in zip(*poses, strict=True))
    clip = Clip(keypoints.path.stem, keypoints.rate, turned, moved)
    return Fitted(clip, tuple(targets), np.stack(distances), limbs)


class _Solver:
    """The least squares of one frame, over turns of joints (about their parents' axes) and the root's place."""

    def __init__(self, skeleton: Skeleton, targets: Sequence[Target], translations: Array) -> None:
        self.skeleton, self.targets, self.translations = skeleton, targets, translations
        chains = [[target.joint, *skeleton.ancestors(target.joint)] for target in targets]
        above = set(skeleton.ancestors(skeleton.root))
        # A joint turns the keypoints below it, and those of the skin of its own part.
        turned = [chain if target.offset.any() else chain[1:] for chain, target in zip(chains, targets, strict=True)]
        self.free = sorted({joint for chain in turned for joint in chain} - above)
        self.moves = np.array([[joint in chain for joint in self.free] for chain in turned])  # [K, n]
        self.weights = np.array([target.weight for target in targets])

    def start(self, points: Array) -> tuple[Array, Array]:
        """The bind pose, turned about the vertical and moved to where a frame's keypoints are."""
        skeleton = self.skeleton
        seen = np.asarray(np.isfinite(points).all(axis=1))
        places, turned, _ = self.places(skeleton.bind_rotations, self.translations)
        a, b = (at[seen] - at[seen].mean(axis=0) for at in (places, points))
        angle = np.arctan2((a[:, 2] * b[:, 0] - a[:, 0] * b[:, 2]).sum(), (a[:, 0] * b[:, 0] + a[:, 2] * b[:, 2]).sum())
        turn = rotation.from_axis_angle(np.array([0.0, 1, 0]), angle)
        root, rotations = skeleton.root, skeleton.bind_rotations.copy()
        above = self._above(turned, root)
        rotations[root] = rotation.multiply(
            rotation.conjugate(above), rotation.multiply(turn, rotation.multiply(above, rotations[root]))
        )
        translations = self.translations.copy()
        offset = (points[seen] - self.places(rotations, translations)[0][seen]).mean(axis=0)
        translations[root] += rotation.rotate(rotation.conjugate(above), offset)
        return rotations, translations

    def places(self, rotations: Array, translations: Array) -> tuple[Array, Array, Array]:
        """Where the targets are [K, 3], and the world's turns [J, 4] and places [J, 3] of all joints."""
        turned, at = self.skeleton.world(rotations, translations)
        joints = [target.joint for target in self.targets]
        offsets = np.stack([target.offset for target in self.targets])
        return at[joints] + rotation.rotate(turned[joints], offsets), turned, at

    def solve(self, rotations: Array, translations: Array, points: Array, steps: int) -> tuple[Array, Array]:
        """The pose nearest to a frame's keypoints [K, 3], from another pose."""
        damping, (error, residual, jacobian) = 1e-4, self._linear(rotations, translations, points)
        for _ in range(steps):
            square = jacobian.T @ jacobian
            step = np.linalg.solve(square + damping * np.eye(len(square)), -jacobian.T @ residual)
            moved = self._moved(rotations, translations, step)
            tried = self._linear(*moved, points)
            if tried[0] >= error:
                damping *= 10
                continue
            (rotations, translations), damping, better = moved, damping / 3, error - tried[0]
            error, residual, jacobian = tried
            if better < ENOUGH * error:
                break
        return rotations, translations

    def _linear(self, rotations: Array, translations: Array, points: Array) -> tuple[float, Array, Array]:
        """Squared error, residual [3 K + 3 n] and its derivatives by the turns of n joints and the root's place."""
        places, turned, at = self.places(rotations, translations)
        seen = np.asarray(np.isfinite(points).all(axis=1))
        weights = np.asarray(self.weights * seen)
        apart = weights[:, None] * np.where(seen[:, None], places - points, 0)
        axes = rotation.to_matrix(np.stack([self._above(turned, joint) for joint in self.free]))
        jacobian = np.zeros((len(points), 3, len(self.free) + 1, 3))
        for i, joint in enumerate(self.free):
            arms = np.where(self.moves[:, i, None], places - at[joint], 0)
            jacobian[:, :, i] = np.cross(axes[i].T[None], arms[:, None]).transpose(0, 2, 1)
        jacobian[:, :, -1] = rotation.to_matrix(self._above(turned, self.skeleton.root))
        jacobian *= weights[:, None, None, None]
        bound = rotation.multiply(rotations[self.free], rotation.conjugate(self.skeleton.bind_rotations[self.free]))
        rest = AT_REST * _vectors(bound)
        rest[[joint == self.skeleton.root for joint in self.free]] = 0  # people may face anywhere
        slack = np.eye(rest.size, rest.size + 3) * AT_REST
        slack[np.repeat([joint == self.skeleton.root for joint in self.free], 3)] = 0
        residual = np.concatenate([apart.ravel(), rest.ravel()])
        return float(residual @ residual), residual, np.concatenate([jacobian.reshape(apart.size, -1), slack])

    def _moved(self, rotations: Array, translations: Array, step: Array) -> tuple[Array, Array]:
        turns, moved = step.reshape(-1, 3), translations.copy()
        angles = np.linalg.norm(turns[:-1], axis=1)
        axes = turns[:-1] / np.where(angles > 0, angles, 1)[:, None]
        turned = rotations.copy()
        turned[self.free] = rotation.normalize(
            rotation.multiply(rotation.from_axis_angle(axes, angles), rotations[self.free])
        )
        moved[self.skeleton.root] += turns[-1]
        return turned, moved

    def _above(self, turned: Array, joint: int) -> Array:
        """The world's turn [4] of the joint above one."""
        parent = self.skeleton.parents[joint]
        return np.asarray(turned[parent]) if parent >= 0 else np.array([1.0, 0, 0, 0])


def _vectors(q: Array) -> Array:
    """Axis times angle [..., 3] of unit quaternions [..., 4]."""
    q = np.where(q[..., :1] < 0, -q, q)
    sine = np.linalg.norm(q[..., 1:], axis=-1, keepdims=True)
    return np.asarray(
        q[..., 1:] * np.where(sine > 0, 2 * np.arctan2(sine, q[..., :1]) / np.where(sine > 0, sine, 1), 2)
    )
