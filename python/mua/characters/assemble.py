"""Merges the pieces of a scene file to one surface on one rigid skeleton; shared by all readers."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from mua.arrays import Array, unique_rows
from mua.atlas.character_surfaces import Surfaces
from mua.characters.alpha import NOTHING_SAID, Alphas, with_alphas
from mua.characters.apart import apart_notes, require_apart
from mua.characters.bind_pose import Bind, bind_pose
from mua.characters.collapsed import without_collapsed
from mua.characters.correction import corrected
from mua.characters.expression_file import with_expression_names
from mua.characters.expressions import fingerprints, joined_targets, unfolding, with_weights
from mua.characters.facing import AS_SHOWN, Facing, turn_about_y
from mua.characters.gaze import GAZE, with_gaze
from mua.characters.messages import UNHELD, Messages, is_about
from mua.characters.rigid_skeleton import rigid_skeleton, roles_of
from mua.characters.smplx import with_pairs, with_smplx
from mua.characters.toon_outline import outlines
from mua.characters.winding import inside_out
from mua.errors import InputError
from mua.limits import MAX_INFLUENCES
from mua.pose.expression_rules import LOOKS, rules_of
from mua.rig.expressions import Expressions
from mua.scene import FaceRules, Part, Scene, Source, Target, without

WELD = 1e-6  # of the character's size: vertices of one mesh nearer than this, with equal weights and targets, are one
WEIGHT_STEP = 1e-5  # weights nearer than this are equal
LOST_WEIGHT = 0.02  # of a vertex: dropping more than this is worth a sentence
OTHER_SIZE = "--height METRES sets another height; --scale FACTOR multiplies the size in the file."


@dataclass(frozen=True, eq=False)
class _Mesh:
    """All parts in one index space, before welding."""

    groups: Array  # [N] int
    vertices: Array  # [N, 3] metres
    indices: Array  # [N, 8] int32 joints
    weights: Array  # [N, 8] float64
    faces: Array  # [F, 3] int
    uv: Array  # [T, 2]
    uv_faces: Array  # [F, 3] int
    face_material: Array  # [F] int32
    colors: Array  # [F, 3, 4] linear
    expressions: Expressions | None
    notes: tuple[str, ...]


def assemble(
    scene: Scene,
    path: Path,
    *,
    leave_out: Sequence[str] = (),
    alphas: Alphas = NOTHING_SAID,
    facing: Facing = AS_SHOWN,
    expression_names: Mapping[str, str] | None = None,
    smplx: Path | None = None,
) -> Surfaces:
    """Merge a scene's parts into one welded mesh on rigid joints, upright, facing +Z and in metres.

    `leave_out` names meshes, nodes or materials whose triangles are no part of the character; `alphas` says how
    materials are transparent where the file is wrong, `expression_names` what its expressions are to be called, and
    `smplx` is the model whose expressions its mesh gets.
    Raises an InputError that names `path` where no skinned triangle is left, or where it holds no such name.
    """
    scene = with_alphas(without(scene, leave_out, path), alphas, path)
    if not any(len(part.faces) for part in scene.parts):
        advice = "" if scene.parts else "; if it holds motion alone, give it with --motion beside a character"
        if any(is_about(note, UNHELD) for note in scene.notes):
            advice = "; add a skeleton in Blender or with Mixamo"
        raise InputError(f"{path}: no skinned mesh with triangles was found, expected a rigged character{advice}")
    scene = without_collapsed(scene, path)
    scene = replace(scene, parts=tuple(replace(part, weights=weighted(part.weights)) for part in scene.parts))
    bind = bind_pose(scene)
    require_apart(scene, bind, path)
    mesh = _merge(scene, bind)
    scene, bind, mesh = _without_outlines(scene, bind, mesh)
    used = mesh.vertices[np.unique(mesh.faces)]
    if not np.ptp(used, axis=0).any():
        raise InputError(f"{path}: all vertices of the skinned meshes are at {used[0].tolist()}, expected a surface")
    scene, change = corrected(
        scene, bind, points=used, stand=True, facing=facing, surface=_middles(mesh, len(bind.nodes))
    )
    if change.moved:
        bind = bind_pose(scene)
    named = scene
    if smplx is not None:
        back = turn_about_y(facing.turn)
        named = with_smplx(scene, smplx, lambda part: _place(scene, part, bind=bind)[0] @ back)
    named = with_expression_names(with_pairs(named), expression_names or {}, path)
    gazing = with_gaze(named, bind)
    if change.moved or gazing is not scene:
        mesh = _merge(gazing, bind)
    looks = LOOKS if gazing is named else (*LOOKS, *GAZE)
    scene = gazing
    size_notes = tuple(f"{note} {OTHER_SIZE}" for note in change.size_notes)
    apart = apart_notes(scene, bind, mesh.vertices)
    mesh = _outward(_weld(mesh))
    unseen = () if mesh.expressions is None else unfolding(mesh.expressions, mesh.vertices, mesh.faces)
    notes = (*size_notes, *change.notes, *mesh.notes, *unseen)
    rigged = rigid_skeleton(scene, bind)
    joint_of_node = np.zeros(len(scene.parents), np.int32)
    joint_of_node[rigged.nodes] = np.arange(len(rigged.nodes))
    shown, face_material = np.unique(mesh.face_material, return_inverse=True)
    indices = np.where(mesh.weights > 0, joint_of_node[bind.nodes[mesh.indices]], 0).astype(np.int32)
    return Surfaces(
        name=scene.name,
        skeleton=rigged.skeleton,
        vertices=mesh.vertices,
        faces=mesh.faces.astype(np.int32),
        uv=mesh.uv,
        uv_faces=mesh.uv_faces.astype(np.int32),
        face_material=face_material.reshape(-1).astype(np.int32),
        materials=tuple(scene.materials[m] for m in shown),
        skin_indices=indices,
        skin_weights=mesh.weights.astype(np.float32),
        expressions=_ruled(mesh.expressions, scene.face_rules, looks),
        clips=with_weights(rigged.clips, scene.motions, () if mesh.expressions is None else mesh.expressions.names),
        source=Source(scene, rigged.nodes),
        corner_colors=None if (mesh.colors == 1).all() else mesh.colors,
        roles=roles_of(scene, rigged),
        notes=(*scene.notes, *apart, *_rigid_parts(scene), *notes, *rigged.notes),
        unit=change.unit,
        size_notes=size_notes,
    )


def _ruled(expressions: Expressions | None, said: FaceRules, looks: Sequence[str]) -> Expressions | None:
    """The expressions with what the file says of them."""
    if expressions is None:
        return None
    rules = rules_of(expressions.names, said.switched, said.overrides, looks)
    return replace(expressions, rules=rules)


def _middles(mesh: _Mesh, joints: int) -> Array:
    """The middle [J, 3] of what each joint carries of a mesh, by its weights; NaN where it carries nothing."""
    used = np.unique(mesh.faces)
    indices, weights = mesh.indices[used].ravel(), mesh.weights[used].ravel()
    points = np.repeat(mesh.vertices[used], mesh.indices.shape[1], axis=0)
    mass = np.bincount(indices, weights, minlength=joints)
    sums = np.stack([np.bincount(indices, weights * column, minlength=joints) for column in points.T], axis=-1)
    with np.errstate(invalid="ignore"):
        return np.asarray(sums / mass[:, None])


def _is_plain(image: Array) -> bool:
    """Whether an image [H, W, 4] has one colour."""
    first = image[:1, :1]
    return bool((image[0] == first).all()) and bool((image == first).all())


def _without_outlines(scene: Scene, bind: Bind, mesh: _Mesh) -> tuple[Scene, Bind, _Mesh]:
    """The scene without outlines: one-coloured shells around other parts, wound inside out, that splats would draw."""
    sizes = [len(part.faces) for part in scene.parts]
    plain = [
        p
        for p, part in enumerate(scene.parts)
        if part.colors is None and _is_plain(scene.materials[part.material].image)
    ]
    found = outlines(mesh.vertices, mesh.faces, np.repeat(np.arange(len(sizes)), sizes), plain)
    if not found:
        return scene, bind, mesh
    messages = Messages()
    for p in found:
        messages.add(
            "Outlines, drawn as shells that are wound inside out, are left out: {}.",
            scene.parts[p].node or scene.parts[p].name,
        )
    kept = tuple(part for p, part in enumerate(scene.parts) if p not in found)
    scene = replace(scene, parts=kept, notes=(*scene.notes, *messages.notes()))
    bind = bind_pose(scene)
    return scene, bind, _merge(scene, bind)


def _rigid_parts(scene: Scene) -> tuple[str, ...]:
    """A sentence on the meshes that only hang on a joint: a hat, a weapon, a robot's limbs."""
    messages = Messages()
    for part in scene.parts:
        if scene.skins[part.skin].rigid:
            messages.add(
                "Meshes that are attached rigidly to a joint (--leave-out NAME leaves one out): {}.", part.node
            )
    return messages.notes()


def limit_influences(
    joints: Array,  # [N, K] int
    weights: Array,  # [N, K] >= 0, rows sum to 1
) -> tuple[Array, Array, float]:
    """Keep the eight largest influences of each vertex, largest first, normalised.

    Returns joints [N, 8] int32, weights [N, 8] and the largest share of weight that a vertex lost. A joint named
    twice counts once with the sum.
    """
    order = np.argsort(joints, axis=1, kind="stable")
    joints = np.take_along_axis(joints, order, axis=1)
    weights = np.take_along_axis(weights, order, axis=1)
    for k in range(1, joints.shape[1]):
        same = joints[:, k] == joints[:, k - 1]
        weights[:, k] += np.where(same, weights[:, k - 1], 0)
        weights[:, k - 1] = np.where(same, 0, weights[:, k - 1])
    order = np.argsort(-weights, axis=1, kind="stable")[:, :MAX_INFLUENCES]
    kept = np.zeros((len(weights), MAX_INFLUENCES))
    indices = np.zeros((len(weights), MAX_INFLUENCES), np.int32)
    kept[:, : order.shape[1]] = np.take_along_axis(weights, order, axis=1)
    indices[:, : order.shape[1]] = np.take_along_axis(joints, order, axis=1)
    indices[kept == 0] = 0
    remaining = kept.sum(axis=1, keepdims=True)
    return indices, kept / remaining, 1 - float(remaining.min(initial=1.0))


def weighted(weights: Array) -> Array:
    """Weights [N, K] scaled to sum to 1; a vertex without any goes to its first joint."""
    weights = weights.astype(float)
    total = weights.sum(axis=1, keepdims=True)
    weights[:, :1] = np.where(total > 0, weights[:, :1], 1)
    return weights / np.where(total > 0, total, 1)


def _merge(scene: Scene, bind: Bind) -> _Mesh:
    columns: dict[str, list[Array]] = {
        name: [] for name in _Mesh.__annotations__ if name not in ("notes", "expressions")
    }
    notes: list[str] = []
    targets: list[Target] = []
    vertex_count = uv_count = 0
    for part in scene.parts:
        indices, weights, lost = limit_influences(_skin_joints(scene, part, bind)[part.joints], part.weights)
        if lost > LOST_WEIGHT:
            notes.append(
                f"Mesh {part.name} has vertices with more than {MAX_INFLUENCES} influences; "
                f"up to {100 * lost:.0f} % of a vertex's weight is dropped."
            )
        vertices, mirrored = _place(scene, part, bind=bind)
        turn = [0, 2, 1] if mirrored else [0, 1, 2]
        columns["groups"].append(np.full(len(vertices), part.group))
        columns["vertices"].append(vertices)
        columns["indices"].append(indices)
        columns["weights"].append(weights)
        columns["faces"].append(part.faces[:, turn] + vertex_count)
        columns["uv"].append(part.uv)
        columns["uv_faces"].append(np.where(part.uv_faces < 0, -1, part.uv_faces + uv_count)[:, turn])
        columns["face_material"].append(np.full(len(part.faces), part.material, np.int32))
        targets += _moved(scene, part, vertices, bind=bind, before=vertex_count)
        colors = np.ones((len(part.faces), 3, 4)) if part.colors is None else part.colors
        columns["colors"].append(colors[:, turn])
        vertex_count += len(vertices)
        uv_count += len(part.uv)
    whole = {name: np.concatenate(column) for name, column in columns.items()}
    expressions, idle = joined_targets(targets, size=float(np.ptp(whole["vertices"], axis=0).max()))
    return _Mesh(**whole, expressions=expressions, notes=(*notes, *idle))


def _moved(scene: Scene, part: Part, vertices: Array, *, bind: Bind, before: int) -> list[Target]:
    """A part's targets in the bind pose, of vertices that are counted from `before`."""
    found = []
    for target in part.targets:
        at = target.vertices
        if len(at):
            there = replace(
                part, positions=part.positions[at] + target.offsets, joints=part.joints[at], weights=part.weights[at]
            )
            offsets = _place(scene, there, bind=bind)[0] - vertices[at]
            found.append(Target(target.name, before + at, offsets))
        else:
            found.append(Target(target.name, at, target.offsets))
    return found


def _skin_joints(scene: Scene, part: Part, bind: Bind) -> Array:
    """The joints [n] of a part's skin among those of the bind pose, whose nodes ascend."""
    return np.searchsorted(bind.nodes, scene.skins[part.skin].joints)


def _place(scene: Scene, part: Part, *, bind: Bind) -> tuple[Array, bool]:
    """A part's vertices [N, 3] in the bind pose, and whether that mirrors its triangles.

    Skins bound in different poses or spaces meet here: each vertex is carried by its own weights.
    """
    joints = _skin_joints(scene, part, bind)
    spaces = bind.matrices[joints] @ scene.skins[part.skin].inverse_binds
    weights = part.weights
    bound = np.zeros_like(part.positions)
    for k in range(weights.shape[1]):
        space = spaces[part.joints[:, k]]
        bound += weights[:, k, None] * (np.einsum("nij,nj->ni", space[:, :3, :3], part.positions) + space[:, :3, 3])
    stretched = np.zeros_like(bound)
    for k in range(weights.shape[1]):
        j = joints[part.joints[:, k]]
        apart = np.einsum("nij,nj->ni", bind.stretch[j], bound - bind.matrices[j, :3, 3])
        stretched += weights[:, k, None] * (bind.places[j] + apart)
    used = np.unique(part.joints[weights > 0])
    return stretched, bool(np.median(np.linalg.det(spaces[used, :3, :3])) < 0)


def _weld(mesh: _Mesh) -> _Mesh:
    """Make one vertex of those of a mesh at one place with equal weights, and drop faces that this leaves empty."""
    size = np.ptp(mesh.vertices, axis=0).max()
    keys = np.concatenate(
        [
            mesh.groups[:, None],
            np.round(mesh.vertices / (WELD * size)),
            mesh.indices,
            np.round(mesh.weights / WEIGHT_STEP),
            *([] if mesh.expressions is None else [fingerprints(mesh.expressions, len(mesh.vertices), size=size)]),
        ],
        axis=1,
    )
    first, welded = first_of_equal(keys.astype(np.int64))
    faces = welded[mesh.faces]
    distinct = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
    kept = np.flatnonzero(distinct)
    kept = np.sort(kept[first_of_equal(np.sort(faces[kept], axis=1))[0]])
    doubled = int(distinct.sum()) - len(kept)
    faces, uv_faces, face_material = faces[kept], mesh.uv_faces[kept], mesh.face_material[kept]
    used, faces = np.unique(faces, return_inverse=True)
    faces = faces.reshape(-1, 3)
    uv, uv_faces = _corners(faces, mesh.uv, uv_faces=uv_faces, face_material=face_material)
    rows = first[used]
    notes = (f"{doubled} duplicate triangles are dropped.",) if doubled else ()
    return replace(
        mesh,
        groups=mesh.groups[rows],
        vertices=mesh.vertices[rows],
        indices=mesh.indices[rows],
        weights=mesh.weights[rows],
        expressions=None if mesh.expressions is None else mesh.expressions.at(rows),
        faces=faces,
        uv=uv,
        uv_faces=uv_faces,
        face_material=face_material,
        colors=mesh.colors[kept],
        notes=(*mesh.notes, *notes),
    )


def _outward(mesh: _Mesh) -> _Mesh:
    """Turn the triangles of closed pieces that are wound inside out: splats are sunk and lit by where these face."""
    turned = inside_out(mesh.vertices, mesh.faces)
    if not turned.any():
        return mesh
    faces, uv_faces, colors = mesh.faces.copy(), mesh.uv_faces.copy(), mesh.colors.copy()
    for corners in (faces, uv_faces, colors):
        corners[turned] = corners[turned][:, ::-1]
    note = f"{np.count_nonzero(turned):,} triangles of closed pieces are wound inside out and are turned."
    return replace(mesh, faces=faces, uv_faces=uv_faces, colors=colors, notes=(*mesh.notes, note))


def first_of_equal(rows: Array) -> tuple[Array, Array]:
    """Indices of the first of each run of equal rows, in order of appearance, and for each row which it equals."""
    _, first, inverse = unique_rows(rows)
    order = np.argsort(first)
    rank = np.empty(len(order), int)
    rank[order] = np.arange(len(order))
    return first[order], rank[inverse]


def _corners(faces: Array, uv: Array, *, uv_faces: Array, face_material: Array) -> tuple[Array, Array]:
    """One UV corner for each vertex, material and UV, so that corners meet exactly where the texture is continuous."""
    mapped = uv_faces[:, 0] >= 0
    corners = uv_faces[mapped].ravel()
    keys = np.stack([faces[mapped].ravel(), np.repeat(face_material[mapped], 3), *uv[corners].T], axis=1)
    first, welded = first_of_equal(keys)
    joined = np.full(uv_faces.shape, -1)
    joined[mapped] = welded.reshape(-1, 3)
    return uv[corners[first]].reshape(-1, 2), joined
