"""Skeleton, template, texels and surface of a file's tree: every shape relation and range checked."""

from dataclasses import replace

import numpy as np

from mua.arrays import Array
from mua.asset.flatbuffer import MAX_BYTES, FormatError, Tree, refuse
from mua.asset.tensors import indices, reals, unit_quaternions
from mua.limits import BARYCENTRIC_SLACK, BIND_BOUND, LARGEST, MAX_INFLUENCES, RULE_CODES, WEIGHT_BOUND
from mua.pose.skeleton import Skeleton
from mua.rig.character import Mesh
from mua.rig.expressions import Expressions
from mua.rig.rig import Rig
from mua.rig.surface import END, Surface, block_triangles, blocks, codes_of, count_codes
from mua.rig.texel_map import CHIEF, TexelMap, centre_barycentrics


def read_skeleton(tree: Tree) -> Skeleton:
    count = len(tree["names"])
    parents = indices(tree["parents"], "skeleton.parents", (count,), -1, count)
    late = np.flatnonzero(parents >= np.arange(count))
    if late.size:
        refuse("skeleton.parents", f"joint {late[0]} stands before its parent {parents[late[0]]}")
    if not tree["root"] < count:
        refuse("skeleton.root", f"{tree['root']}, but there are {count} joints")
    skeleton = Skeleton(
        names=tuple(tree["names"]),
        parents=parents,
        bind_rotations=unit_quaternions(tree["bind_rotations"], "skeleton.bind_rotations", (count, 4)),
        bind_translations=reals(tree["bind_translations"], "skeleton.bind_translations", (count, 3)),
        root=tree["root"],
    )
    stated = reals(tree["bind_inverse"], "skeleton.bind_inverse", (count, 8))
    gaps = [np.abs(stated - sign * skeleton.bind_inverse).max(axis=1) for sign in (1, -1)]  # of a dual quaternion
    gap = np.minimum(*gaps).max()
    if gap > BIND_BOUND:
        refuse("skeleton.bind_inverse", f"differs by {gap:.1e} from the inverse of the bind pose")
    return skeleton


def read_translated(tree: Tree, path: str, skeleton: Skeleton) -> Array:
    """Joints beside the root that move in their parents; none in a file that names none."""
    if "translated" not in tree:
        return np.zeros(0, dtype=np.int32)
    joints = indices(tree["translated"], path, (None,), 0, len(skeleton.names))
    if np.any(np.diff(joints) <= 0) or skeleton.root in joints:
        refuse(path, "joints must ascend and leave out the root")
    return joints


def read_rig(tree: Tree, skeleton: Skeleton, vertices: Array) -> Rig:
    template, count = tree["template"], len(vertices)
    uv = reals(template["uv"], "template.uv", (None, 2))
    faces = indices(template["faces"], "template.faces", (None, 3), 0, count)
    uv_faces = indices(template["uv_faces"], "template.uv_faces", (len(faces), 3), 0, len(uv))
    influences = (count, MAX_INFLUENCES)
    weights = reals(template["skin_weights"], "template.skin_weights", influences)
    sums = weights.sum(axis=1)
    if weights.min(initial=0) < 0 or np.abs(sums - 1).max(initial=0) > WEIGHT_BOUND:
        vertex = int(np.abs(sums - 1).argmax())
        refuse("template.skin_weights", f"weights of vertex {vertex} sum to {sums[vertex]:.4g} or one is negative")
    if np.any(weights[:, 1:] > weights[:, :-1]):
        vertex = int((weights[:, 1:] > weights[:, :-1]).any(axis=1).argmax())
        refuse("template.skin_weights", f"weights of vertex {vertex} do not begin with the largest")
    mesh = Mesh(vertices=vertices, faces=faces, uv=uv, uv_faces=uv_faces)
    return Rig(
        skeleton=skeleton,
        mesh=mesh,
        skin_indices=indices(template["skin_indices"], "template.skin_indices", influences, 0, len(skeleton.names)),
        skin_weights=weights,
        texels=_texels(tree["texels"], mesh),
    )


def _texels(tree: Tree, mesh: Mesh) -> TexelMap:
    size = tree["size"]
    texels = indices(tree["texels"], "texels.texels", (None,), 0, size * size)
    if np.any(np.diff(texels) <= 0):
        refuse("texels.texels", "texels must ascend")
    triangles = indices(tree["triangles"], "texels.triangles", (len(texels),), 0, len(mesh.faces))
    first = _barycentrics(tree, mesh, texels, triangles)
    barycentrics = np.column_stack([first, 1 - first.sum(axis=1)])
    if barycentrics.min(initial=0) < -BARYCENTRIC_SLACK:
        refuse("texels.barycentrics", f"{barycentrics.min():.3g}, expected 0 to 1")
    one_sided = _one_sided(tree["one_sided"], len(texels)) if "one_sided" in tree else None
    if not 0 <= tree["length"] <= LARGEST:
        refuse("texels.length", f"{tree['length']}, expected 0 to {LARGEST:.6g}")
    found = TexelMap(
        size=size,
        texels=texels,
        triangles=triangles,
        barycentrics=np.maximum(barycentrics, 0),
        claimed_twice=0,
        one_sided=one_sided,
        levels=tuple(level["blocks"] for level in tree["levels"]),
        length=tree["length"],
    )
    _require_levels(found)
    return found


def _require_levels(texels: TexelMap) -> None:
    for number, codes in enumerate(texels.levels or ()):
        path, (_, four) = f"texels.levels[{number}].blocks", texels.blocks()
        if len(codes) != len(four):
            raise FormatError("shape", path, f"{len(codes)} bytes, expected {len(four)}")
        kinds = codes[:, None] >> 2 * np.arange(4) & 3
        wrong = np.flatnonzero(((kinds == CHIEF).sum(axis=1) != 1) | (kinds.astype(bool) & (four < 0)).any(axis=1))
        if wrong.size:
            refuse(path, f"block {wrong[0]} has not one chief, or a member that is no valid texel")
        texels = texels.halved()


def _one_sided(content: Array, count: int) -> Array:
    """[N] bool, from a bit for each texel."""
    expected = -(-count // 8)
    if len(content) != expected:
        raise FormatError("shape", "texels.one_sided", f"{len(content)} bytes, expected {expected}")
    return np.unpackbits(content, count=count, bitorder="little").astype(bool)


def _barycentrics(tree: Tree, mesh: Mesh, texels: Array, triangles: Array) -> Array:
    """[N, 2] as stored, or computed where only those of the listed texels are."""
    if "listed" not in tree:
        return reals(tree["barycentrics"], "texels.barycentrics", (len(texels), 2))
    listed = indices(tree["listed"], "texels.listed", (None,), 0, len(texels))
    if np.any(np.diff(listed) <= 0):
        refuse("texels.listed", "texels must ascend")
    stored = reals(tree["barycentrics"], "texels.barycentrics", (len(listed), 2))
    found = centre_barycentrics(mesh, tree["size"], texels, triangles)
    found[listed] = stored
    if not np.isfinite(found).all():
        refuse("texels.listed", "a texel is not listed, but its triangle has no area in UV")
    return found


def read_surface(tree: Tree, texels: TexelMap) -> Surface:
    corners, runs = blocks(texels), tree["runs"]
    if count_codes(runs) != len(corners):
        raise FormatError("shape", "surface.runs", f"{count_codes(runs)} codes, expected {len(corners)}")
    if block_triangles(corners, codes_of(runs)).min(initial=0) < 0:
        refuse("surface.runs", "a triangle has a corner that is no valid texel")
    return Surface(runs, indices(tree["strips"], "surface.strips", (None,), END, 2 * len(texels.texels)))


def with_expressions(rig: Rig, tree: Tree) -> Rig:
    """The rig with the file's expressions, where it has any."""
    if "expressions" not in tree:
        return rig
    table, vertices = tree["expressions"], len(rig.mesh.vertices)
    names = tuple(table["names"])
    for number, name in enumerate(names):
        if not name or names.index(name) < number:
            refuse(f"expressions.names[{number}]", f"{name!r} is empty or stands there twice")
    starts = indices(table["starts"], "expressions.starts", (len(names) + 1,), 0, MAX_BYTES)
    if starts[0] or np.any(np.diff(starts) < 0):
        refuse("expressions.starts", "the starts must begin with 0 and never fall")
    moved = indices(table["vertices"], "expressions.vertices", (int(starts[-1]),), 0, vertices)
    falls = np.flatnonzero(np.diff(moved) <= 0) + 1
    if not np.isin(falls, starts).all():
        refuse("expressions.vertices", "vertices must ascend within an expression")
    offsets = reals(table["offsets"], "expressions.offsets", (len(moved), 3))
    gains = reals(table["gains"], "expressions.gains", (len(moved),)) if "gains" in table else None
    rules = indices(table["rules"], "expressions.rules", (len(names),), 0, RULE_CODES) if "rules" in table else None
    return replace(rig, expressions=Expressions(names, starts, moved, offsets, gains, rules))
