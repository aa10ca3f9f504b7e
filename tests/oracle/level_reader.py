"""A file's coarser levels of detail, written from section 9 of schemas/README.md alone, block by block."""

import math
from typing import Any

import numpy as np

GROWTH = 37 / 20
Tree = dict[str, Any]
Array = np.ndarray[Any, np.dtype[Any]]


def levels(avatar: Tree) -> int:
    """9.1: the coarsest, of a tree that `decoder.read` gives."""
    details = max(len(avatar[name]["details"]) for name in ("geometry", "appearance"))
    return 0 if len(avatar["wavelet"]["rec_lo"]) > 32 else min(2, int(avatar["wavelet"]["levels"]) - details)


def coarser(avatar: Tree) -> Tree:
    """The next level."""
    texels, static = avatar["texels"], avatar["geometry"]["static_offset"]
    size, numbers = int(texels["size"]), texels["texels"].tolist()
    surface, reach = _surface(avatar)
    place = surface + static[:3].T  # 9.2
    blocks: dict[tuple[int, int], list[int]] = {}
    for e, texel in enumerate(numbers):  # 9.3
        blocks.setdefault((texel // size // 2, texel % size // 2), []).append(e)
    chiefs, geometry, appearance, one_sided = [], [], [], []
    bits = texels.get("one_sided", bytes(len(numbers)))
    for _, held in sorted(blocks.items()):  # 9.4
        near = {e: [g for g in held if math.dist(place[e], place[g]) <= reach] for e in held}
        chief = max(held, key=lambda e: len(near[e]))  # the first of equals
        members = near[chief]
        alike = [e for e in members if math.dist(static[3:7, e], static[3:7, chief]) <= 1]
        own = static[:, members].mean(axis=1)  # 9.5
        own[0:3] = place[members].mean(axis=0) - surface[chief]
        own[3:7] = static[3:7, alike].mean(axis=1)
        own[7:10] += 0.5 * math.log2(len(members)) * math.log(GROWTH)
        chiefs.append(chief)
        one_sided.append(all(bits[e // 8] >> e % 8 & 1 for e in members))
        geometry.append(own)
        appearance.append(avatar["appearance"]["static_offset"][:, members].mean(axis=1))
    shown = {
        "size": size // 2,
        "texels": np.array([row * (size // 2) + col for row, col in sorted(blocks)]),
        "triangles": texels["triangles"][chiefs],
        "barycentrics": texels["barycentrics"][chiefs],
        "one_sided": np.packbits(one_sided, bitorder="little"),
    }
    return {
        **avatar,
        "level": avatar.get("level", 0) + 1,
        "texels": shown,
        "geometry": {**avatar["geometry"], "static_offset": np.array(geometry).T},
        "appearance": {**avatar["appearance"], "static_offset": np.array(appearance).T},
    }


def _surface(avatar: Tree) -> tuple[Array, float]:
    """s [N, 3] of 9.2 and the reach of 9.4."""
    mean, faces, texels = avatar["coarse"]["mean"], avatar["template"]["faces"], avatar["texels"]
    two = texels["barycentrics"]
    weights = np.column_stack([two, np.maximum(1 - two.sum(axis=1), 0)])
    area = sum(np.linalg.norm(np.cross(mean[b] - mean[a], mean[c] - mean[a])) / 2 for a, b, c in faces)
    return np.einsum("nk,nki->ni", weights, mean[faces[texels["triangles"]]]), 6 * math.sqrt(area / len(two))
