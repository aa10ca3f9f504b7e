"""The rig as a .npz file without pickles, and the hash that identifies a rig."""

import hashlib
from pathlib import Path

import numpy as np

from mua.arrays import Array
from mua.files.npz import read_npz
from mua.files.write import replacing
from mua.pose.skeleton import Skeleton
from mua.rig.character import Mesh
from mua.rig.expressions import Expressions
from mua.rig.rig import Rig
from mua.rig.texel_map import TexelMap

NAMES = (
    *("names", "parents", "bind_rotations", "bind_translations", "root"),
    *("vertices", "faces", "uv", "uv_faces", "skin_indices", "skin_weights"),
    *("size", "texels", "triangles", "barycentrics", "claimed_twice"),
)
EXPRESSIONS = tuple(f"expression_{part}" for part in ("names", "starts", "vertices", "offsets"))  # where there are any
GAINS = "expression_gains"  # where light is known
RULES = "expression_rules"  # where an expression has any


def rig_hash(rig: Rig) -> str:
    """SHA-256 over names, shapes, types and bytes of everything in `rig`."""
    digest = hashlib.sha256()
    for name, array in sorted(_arrays(rig).items()):
        digest.update(f"{name} {array.shape} {array.dtype}".encode())
        digest.update(np.ascontiguousarray(array).tobytes())
    return digest.hexdigest()


def write_rig(path: Path, rig: Rig) -> None:
    with replacing(path) as temporary:
        np.savez(temporary, allow_pickle=False, **_arrays(rig))


def read_rig(path: Path) -> Rig:
    """Raises InputError for a file that is missing, damaged or lacks an array."""
    return _rig(read_npz(path, NAMES, optional=(*EXPRESSIONS, GAINS, RULES)))


def _arrays(rig: Rig) -> dict[str, Array]:
    return {
        "names": np.array(rig.skeleton.names),
        "parents": rig.skeleton.parents,
        "bind_rotations": rig.skeleton.bind_rotations,
        "bind_translations": rig.skeleton.bind_translations,
        "root": np.array(rig.skeleton.root),
        "vertices": rig.mesh.vertices,
        "faces": rig.mesh.faces,
        "uv": rig.mesh.uv,
        "uv_faces": rig.mesh.uv_faces,
        "skin_indices": rig.skin_indices,
        "skin_weights": rig.skin_weights,
        "size": np.array(rig.texels.size),
        "texels": rig.texels.texels,
        "triangles": rig.texels.triangles,
        "barycentrics": rig.texels.barycentrics,
        "claimed_twice": np.array(rig.texels.claimed_twice),
        **_expression_arrays(rig.expressions),
    }


def _expression_arrays(expressions: Expressions | None) -> dict[str, Array]:
    if expressions is None:
        return {}
    parts = (np.array(expressions.names), expressions.starts, expressions.vertices, expressions.offsets)
    more = {GAINS: expressions.gains, RULES: expressions.rules}
    return dict(zip(EXPRESSIONS, parts, strict=True)) | {name: a for name, a in more.items() if a is not None}


def _rig(a: dict[str, Array]) -> Rig:
    names = tuple(str(name) for name in a["names"])
    return Rig(
        Skeleton(names, a["parents"], a["bind_rotations"], a["bind_translations"], int(a["root"])),
        Mesh(a["vertices"], a["faces"], a["uv"], a["uv_faces"]),
        a["skin_indices"],
        a["skin_weights"],
        TexelMap(int(a["size"]), a["texels"], a["triangles"], a["barycentrics"], int(a["claimed_twice"])),
        _expressions(a),
    )


def _expressions(a: dict[str, Array]) -> Expressions | None:
    if not all(name in a for name in EXPRESSIONS):
        return None
    names, starts, vertices, offsets = (a[name] for name in EXPRESSIONS)
    return Expressions(tuple(str(name) for name in names), starts, vertices, offsets, a.get(GAINS), a.get(RULES))
