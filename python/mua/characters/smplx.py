"""Expressions of SMPL-X: shape keys named as its Blender add-on does, or directions of the user's own model file.

Layout of the file, of which no part is kept here: https://github.com/vchoutas/smplx
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy.spatial import KDTree

from mua.arguments import finite_array
from mua.arrays import Array
from mua.errors import InputError
from mua.files.npz import read_npz
from mua.pose.signed_expressions import UNIT, WAYS, signed_name
from mua.scene import Part, Scene, Target

COUNT = 10  # directions of shapes and of expressions that are taken: as many as the add-on has
SHAPES_FIRST = {400: 300, 20: 10}  # by how many directions a file has, which of them is the first expression's
NEAR = 1e-3  # metres: how far a vertex of the character or the model may be from the nearest of the other
ROUNDS = 50  # at most, of finding the nearest vertices and the shape that they tell


@dataclass(frozen=True, eq=False)
class _Model:
    """A file of SMPL-X, at rest: metres, Y up, facing +Z."""

    template: Array  # [V, 3]
    shapes: Array  # [V, 3, COUNT]
    expressions: Array  # [V, 3, COUNT]


def with_pairs(scene: Scene) -> Scene:
    """The scene with a pair of targets, one for each way, in place of each that is a coefficient of SMPL-X."""
    if not any(signed_name(target.name) for part in scene.parts for target in part.targets):
        return scene
    parts = (replace(part, targets=tuple(one for t in part.targets for one in _pair(t))) for part in scene.parts)
    return replace(scene, parts=tuple(parts))


def _pair(target: Target) -> Iterator[Target]:
    name = signed_name(target.name)
    if name is None:
        yield target
    else:
        yield from (
            replace(target, name=name + way, offsets=sign * UNIT * target.offsets) for way, sign in WAYS.items()
        )


def with_smplx(
    scene: Scene,
    path: Path,  # of the model
    place: Callable[[Part], Array],  # the vertices [N, 3] of a part at rest: metres, Y up, facing +Z
) -> Scene:
    """The scene with the model's expressions as targets of the meshes that are the model's, in whatever shape.

    Errors: InputError where the file is no SMPL-X model, no mesh is the model's, or the scene has such targets already.
    """
    if any(signed_name(target.name) for part in scene.parts for target in part.targets):
        raise InputError(f"--smplx {path}: the character has expressions of SMPL-X already; leave the option out")
    model, parts, least = _read(path), list(scene.parts), np.inf
    for group in dict.fromkeys(part.group for part in parts):
        own = [p for p, part in enumerate(parts) if part.group == group]
        points = [place(parts[p]) for p in own]
        vertices, distance = _matched(np.concatenate(points), model)
        least = min(least, distance)
        if distance <= NEAR:
            ends = np.cumsum([len(placed) for placed in points])[:-1]
            for p, placed, rows in zip(own, points, np.split(vertices, ends), strict=True):
                parts[p] = _expressive(parts[p], placed, model.expressions[rows], place)
    if least > NEAR:
        raise InputError(
            f"--smplx {path}: no mesh of the character is this model's in any shape: a vertex is {1000 * least:.1f} mm "
            f"from its nearest, expected {1000 * NEAR:g} mm or less"
        )
    return replace(scene, parts=tuple(parts))


def _read(path: Path) -> _Model:
    arrays = read_npz(path, ("v_template", "shapedirs"))
    template = finite_array(arrays["v_template"], f"{path}: v_template", (None, 3))
    directions = finite_array(arrays["shapedirs"], f"{path}: shapedirs", (len(template), 3, None))
    first = SHAPES_FIRST.get(directions.shape[2])
    if first is None or not len(template):
        raise InputError(
            f"{path}: shapedirs: the shape is {list(directions.shape)}, expected the "
            f"{' or '.join(map(str, SHAPES_FIRST))} directions of SMPL-X"
        )
    return _Model(template, directions[..., :COUNT], directions[..., first : first + COUNT])


def _matched(points: Array, model: _Model) -> tuple[Array, float]:
    """The model's vertex [N] at each of the points [N, 3], and how far the worst of either is from the nearest other.

    Place and shape of the model, both unknown, follow by least squares from the nearest vertices, and these from them.
    """
    middle = (points.min(axis=0) + points.max(axis=0) - model.template.min(axis=0) - model.template.max(axis=0)) / 2
    surface, nearest = model.template + middle, np.full(len(points), -1)
    for _ in range(ROUNDS):
        before = nearest
        distances, nearest = KDTree(surface).query(points)
        if (nearest == before).all():
            break
        moves = np.broadcast_to(np.eye(3), (len(points), 3, 3))
        columns = np.concatenate([model.shapes[nearest], moves], axis=2).reshape(3 * len(points), -1)
        found = np.linalg.lstsq(columns, (points - model.template[nearest]).ravel(), rcond=None)[0]
        surface = model.template + model.shapes @ found[:-3] + found[-3:]
    return nearest, float(max(distances.max(), KDTree(points).query(surface)[0].max()))


def _expressive(
    part: Part,
    placed: Array,  # [N, 3] its vertices as `place` has them
    directions: Array,  # [N, 3, COUNT] there
    place: Callable[[Part], Array],
) -> Part:
    """The part with a pair of targets for each direction, in the mesh's own space, from which `place` is linear."""
    steps = [place(replace(part, positions=part.positions + step)) - placed for step in np.eye(3)]
    own = np.linalg.solve(np.stack(steps, axis=2), directions)
    targets: list[Target] = []
    for number in range(directions.shape[2]):
        at = np.flatnonzero(directions[..., number].any(axis=1))
        targets += _pair(Target(f"Exp{number:03}", at, own[at, :, number]))
    return replace(part, targets=(*part.targets, *targets))
