"""Checks rigs assembled by other programs: shapes, sizes, and whether template and skeleton belong together."""

from collections.abc import Iterator

import numpy as np

from mua.arrays import Array
from mua.pose.skeleton import Skeleton
from mua.recording.plausible.finding import Finding
from mua.recording.plausible.fit import explain, rms, unit_of
from mua.rig.rig import Rig

SMALLEST, LARGEST = 0.01, 100.0  # metres: the sizes of figures that bake, bounds and player are made for
PERSON = 1.75  # metres
WEIGHT_ERROR = 1e-3  # tolerance of the sum of a vertex's skin weights
INSIDE_OUT = -0.3  # share of the volumes of all triangles' tetrahedra, with inward ones negative
FEW = 3  # joints with skin; fewer prove nothing
NEAR = 0.2  # share of the figure's size: their distance once a mistake is undone
APART = 0.3  # share of the figure's size: mean distance allowed between joints and the skin they move


def rig_findings(rig: Rig) -> Iterator[Finding]:
    """Likely mistakes in a rig; wrong shapes or indices are reported alone."""
    wrong = list(_names(rig.skeleton)) or list(_shapes(rig)) or list(_indices(rig))
    yield from wrong or [*_size(rig), *_weights(rig), *_joints(rig), *_facing(rig)]


def _names(skeleton: Skeleton) -> Iterator[Finding]:
    """Every joint has its own name, by which motion and the players find it."""
    names, joints = skeleton.names, len(skeleton.parents)
    if len(names) != joints:
        yield Finding(
            f"skeleton.names has {len(names)} names, expected {joints}, as skeleton.parents has", certain=True
        )
    first: dict[str, int] = {}
    for joint, name in enumerate(names):
        if not isinstance(name, str) or not name.strip():
            yield Finding(f"skeleton.names: joint {joint} is named {name!r}, expected a text", certain=True)
        elif name in first:
            found = f"skeleton.names: {name!r} is the name of joints {first[name]} and {joint}"
            yield Finding(f"{found}, expected names that differ", certain=True)
        else:
            first[name] = joint


def _shapes(rig: Rig) -> Iterator[Finding]:
    mesh, skeleton, texels = rig.mesh, rig.skeleton, rig.texels
    joints, vertices, valid = len(skeleton.names), len(mesh.vertices), len(texels.texels)
    expected: dict[str, tuple[Array, tuple[int, ...]]] = {
        "skeleton.parents": (skeleton.parents, (joints,)),
        "skeleton.bind_rotations": (skeleton.bind_rotations, (joints, 4)),
        "skeleton.bind_translations": (skeleton.bind_translations, (joints, 3)),
        "mesh.vertices": (mesh.vertices, (vertices, 3)),
        "mesh.uv_faces": (mesh.uv_faces, mesh.faces.shape),
        "skin_indices": (rig.skin_indices, (vertices, 8)),
        "skin_weights": (rig.skin_weights, (vertices, 8)),
        "texels.triangles": (texels.triangles, (valid,)),
        "texels.barycentrics": (texels.barycentrics, (valid, 3)),
    }
    for name, (array, shape) in expected.items():
        if array.shape != shape:
            yield Finding(f"{name} has shape {list(array.shape)}, expected {list(shape)}", certain=True)
        elif not np.isfinite(array).all():
            yield Finding(f"{name} holds a value that is no number, expected finite ones", certain=True)


def _indices(rig: Rig) -> Iterator[Finding]:
    """Indices into vertices, joints and triangles are in range, where all shapes are right."""
    mesh, skeleton, texels = rig.mesh, rig.skeleton, rig.texels
    joints, vertices, valid = len(skeleton.names), len(mesh.vertices), len(texels.texels)
    limits = {
        "mesh.faces": (mesh.faces, vertices),
        "mesh.uv_faces": (mesh.uv_faces, len(mesh.uv)),
        "skin_indices": (rig.skin_indices, joints),
        "texels.triangles": (texels.triangles, len(mesh.faces)),
        "texels.texels": (texels.texels, texels.size**2),
    }
    for name, (indices, limit) in limits.items():
        if len(indices) and not 0 <= indices.min() <= indices.max() < limit:
            yield Finding(f"{name} holds {indices.min()} to {indices.max()}, expected 0 to {limit - 1}", certain=True)
    if (skeleton.parents >= np.arange(joints)).any():
        yield Finding("skeleton.parents: a parent comes after its child, expected parents first", certain=True)
    if not valid:
        yield Finding("texels: no texel is valid, expected those under the UV charts", certain=True)


def _size(rig: Rig) -> Iterator[Finding]:
    size = float(np.ptp(rig.mesh.vertices, axis=0).max())
    if not SMALLEST <= size <= LARGEST:
        unit = unit_of(size / PERSON)
        question = f"is it in {unit}? metres are expected" if unit else f"expected {SMALLEST} to {LARGEST:.0f} m"
        yield Finding(f"the longest side of the template is {size:.4g} m: {question}", certain=True)


def _weights(rig: Rig) -> Iterator[Finding]:
    total = rig.skin_weights.sum(axis=1)
    worst = int(np.argmax(np.abs(total - 1)))
    if rig.skin_weights.min(initial=0) < 0 or abs(total[worst] - 1) > WEIGHT_ERROR:
        found = f"skin_weights of vertex {worst} sum to {total[worst]:.4g}, the least is {rig.skin_weights.min():.4g}"
        yield Finding(f"{found}: expected weights from 0 to 1 that sum to 1", certain=True)


def _joints(rig: Rig) -> Iterator[Finding]:
    """Every joint is near the skin that it moves, whatever the character."""
    skeleton, vertices = rig.skeleton, rig.mesh.vertices
    size = float(np.ptp(vertices, axis=0).max())
    lengths = np.linalg.norm(skeleton.bind_rotations, axis=1)
    if np.abs(lengths - 1).max() > WEIGHT_ERROR:
        yield Finding(
            "skeleton.bind_rotations: a quaternion is not of length 1, expected wxyz of length 1", certain=True
        )
        return
    main = rig.skin_indices[np.arange(len(vertices)), np.argmax(rig.skin_weights, axis=1)]
    used, owner = np.unique(main, return_inverse=True)
    count = np.bincount(owner)[:, None]
    skin = np.stack([np.bincount(owner, weights=axis) for axis in vertices.T], axis=1) / count
    places = _places(skeleton, skeleton.bind_rotations)[used]
    apart = rms(places - skin)
    if apart <= APART * size or len(used) < FEW:
        return
    found = f"joints are {apart:.3g} m from the skin that they move, on average, of a figure of {size:.3g} m"
    mistake = explain(places, skin)
    if mistake is not None:
        yield Finding(f"{found}: {mistake.question} (of the skeleton, beside the template)", certain=True)
        return
    others = {
        "bind_rotations are xyzw: are they? wxyz is expected": _places(
            skeleton, np.roll(skeleton.bind_rotations, 1, 1)
        ),
        "bind_translations are places in the world: are they?": skeleton.bind_translations,
    }
    left, question = min((rms(other[used] - skin), question) for question, other in others.items())
    if left < min(NEAR * size, apart / 2):
        yield Finding(f"{found}, and {left:.3g} m if {question}", certain=True)


def _facing(rig: Rig) -> Iterator[Finding]:
    """The volume that a surface encloses is positive where its triangles are counter-clockwise seen from outside."""
    corners = (rig.mesh.vertices - rig.mesh.vertices.mean(axis=0))[rig.mesh.faces]
    volumes = np.einsum("fi,fi->f", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))
    if volumes.sum() < INSIDE_OUT * np.abs(volumes).sum():
        found = "triangles of the template face inward: are they clockwise, or is the mesh mirrored?"
        yield Finding(f"{found} Counter-clockwise seen from outside is expected", certain=False)


def _places(skeleton: Skeleton, rotations: Array) -> Array:
    return skeleton.world(rotations, skeleton.bind_translations)[1]
