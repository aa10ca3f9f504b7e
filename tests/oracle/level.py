"""Section 9 of schemas/README.md: an avatar at the next coarser level of detail."""

from math import log, log2

import numpy as np
from oracle.file import Tree
from oracle.splats import corner_weights
from oracle.texture import one_sided, places


def coarser(avatar: Tree) -> Tree:
    """The avatar whose texture has half as many texels along a side."""
    texels, size = avatar["texels"], avatar["texels"]["size"]
    geometry, appearance = (avatar[name]["static_offset"] for name in ("geometry", "appearance"))
    corners = avatar["coarse"]["mean"][avatar["template"]["faces"][texels["triangles"]]]
    s = np.einsum("nk,nki->ni", corner_weights(avatar), corners)
    blocks: dict[int, dict[int, int]] = {}
    for e, texel in enumerate(map(int, texels["texels"])):  # 9.1
        row, col = divmod(texel, size)
        blocks.setdefault(row // 2 * (size // 2) + col // 2, {})[2 * (row % 2) + col % 2] = e
    chiefs, hidden, columns = [], [], []
    for (_, held), code in zip(sorted(blocks.items()), map(int, texels["levels"][0]["blocks"]), strict=True):  # 9.2
        kinds = {e: code >> 2 * corner & 3 for corner, e in held.items()}
        members, [h] = [e for e in kinds if kinds[e]], [e for e in kinds if kinds[e] == 3]
        own = geometry[:, members].mean(axis=1)  # 9.3
        own[0:3] = (s[members] + geometry[0:3, members].T).mean(axis=0) - s[h]
        own[3:7] = geometry[3:7, [e for e in kinds if kinds[e] >= 2]].mean(axis=1)
        own[7:10] += 0.5 * log2(len(members)) * log(1.85)
        columns.append(np.concatenate([own, appearance[:, members].mean(axis=1)]))
        chiefs.append(h)
        hidden.append(bool(one_sided(texels)[members].all()))
    static = np.array(columns).reshape(-1, len(geometry) + len(appearance)).T
    next_texels = {
        "size": size // 2,
        "texels": np.array(sorted(blocks), dtype=int),
        "triangles": texels["triangles"][chiefs],
        "barycentrics": places(avatar)[chiefs],
        "one_sided": np.packbits(hidden, bitorder="little"),
        "levels": texels["levels"][1:],
    }
    return {
        **avatar,
        "level": avatar.get("level", 0) + 1,
        "texels": next_texels,
        "geometry": {**avatar["geometry"], "static_offset": static[: len(geometry)]},
        "appearance": {**avatar["appearance"], "static_offset": static[len(geometry) :]},
    }
