"""A file for the network: tensors packed, what a reader computes left out, and what is shown first put first."""

from collections.abc import Callable, Sequence

import numpy as np

from mua.arrays import Array
from mua.asset.flatbuffer import Tree, build
from mua.asset.packing import packed, tensors
from mua.asset.tensors import pack, pack_indices
from mua.rig.rig import Rig
from mua.rig.texel_map import centre_barycentrics

COMPUTED = 1e-4  # of a triangle, by which a computed barycentric may be beside the avatar's
BRANCHES = ("geometry.", "appearance.")


def build_packed(tree: Tree, rig: Rig) -> bytes:
    """The bytes of a plain file's tree as one for the network, not yet sealed."""
    tree = {**tree, "texels": {**tree["texels"], **_listed(rig)}}
    for _, tensor in tensors(tree):
        tensor.update(packed(tensor))
    return build(tree, _stages(tree))


def _listed(rig: Rig) -> Tree:
    """The barycentrics of texels whose centre does not lie in their triangle, as those along the rims of charts."""
    texels, own = rig.texels, rig.texels.barycentrics[:, :2]
    computed = centre_barycentrics(rig.mesh, texels.size, texels.texels, texels.triangles)
    listed = np.flatnonzero(~(np.abs(computed - own) <= COMPUTED).all(axis=1))  # what is not computed is NaN
    return {"listed": pack_indices(listed), "barycentrics": pack(own[listed])}


def _is_late(path: str) -> bool:
    return path.startswith(("clips[", "surface", "expressions")) and not path.startswith("clips[0]")


def _is_part(name: str) -> Callable[[str], bool]:
    return lambda path: path.startswith(BRANCHES) and f".{name}" in path


def _moves(path: str) -> bool:
    return path.startswith(("coarse.", *BRANCHES)) and not path.endswith(("ll_mean", "coarse.mean"))


def _is_low(path: str) -> bool:
    return path.startswith(("texels", *BRANCHES))


# Of a tensor's path, the last stage first: what no earlier one takes is of the mesh, the first.
STAGES: tuple[Callable[[str], bool], ...] = (_is_late, _is_part("static_offset"), _moves, _is_low)


def _stages(tree: Tree) -> Sequence[Sequence[Array]]:
    """The data of the mean mesh, of mean splats, of what moves with details last, of the static offset, of all else."""
    stages: list[list[Array]] = [[] for _ in range(len(STAGES) + 1)]
    found = sorted(tensors(tree), key=lambda place: _level(place[0]))
    for path, tensor in found:
        late = next((number for number, holds in enumerate(STAGES) if holds(path)), len(STAGES))
        stages[len(STAGES) - late].append(tensor["data"])
    stages[0].insert(0, tree["thumbnail"])
    stages[1] += [level["blocks"] for level in tree["texels"]["levels"]]
    if "one_sided" in tree["texels"]:
        stages[1].append(tree["texels"]["one_sided"])
    if "surface" in tree:
        stages[-1].append(tree["surface"]["runs"])
    return stages


def _level(path: str) -> int:
    """Of a detail, that those of both branches stand together, from 1; 0 of all else."""
    return 1 + int(path.split("details[")[1].split("]")[0]) if "details[" in path else 0
