"""The valid texels: where they lie on the mesh, and their levels of detail: sections 5 and 9."""

from dataclasses import dataclass

import numpy as np
from oracle.file import Array, Record


@dataclass(frozen=True)
class Texels:
    size: int
    texels: Array  # [N] row * size + column
    triangles: Array  # [N]
    barycentrics: Array  # [N, 2] b_0, b_1
    one_sided: Array  # [N] bool
    static_offset: Array  # [23, N] geometry, then appearance
    corners: Array  # f [N, 3] vertices

    def weights(self) -> Array:
        """6.4: b_0, b_1 and b_2 [N, 3]."""
        return np.column_stack([self.barycentrics, np.maximum(1 - self.barycentrics.sum(axis=1), 0)])


def levels(avatar: Record) -> list[Texels]:
    """All levels of detail, level 0 first."""
    file, static = avatar.texels, [branch.static_offset for branch in (avatar.geometry, avatar.appearance)]
    places = barycentrics(file, avatar.template), one_sided(file), np.concatenate(static)
    found = [Texels(file.size, file.texels, file.triangles, *places, avatar.template.faces[file.triangles])]
    for level in file.levels:
        found.append(coarser(found[-1], level.blocks, avatar.coarse.mean))
    return found


def barycentrics(file: Record, template: Record) -> Array:
    """5.5: b_0 and b_1 [N, 2]."""
    if file.listed is None:
        return np.maximum(file.barycentrics, 0)
    centres = np.stack([file.texels % file.size, file.texels // file.size], axis=-1) + 0.5
    x, y = (template.uv[template.uv_faces[file.triangles]] * file.size - centres[:, None]).T  # [3, N]
    areas = np.array([x[i] * y[j] - y[i] * x[j] for i, j in ((1, 2), (2, 0), (0, 1))])
    whole = areas[0] + areas[1] + areas[2]
    shares = areas / np.where(whole == 0, 1, whole)
    first = np.clip(shares[0], 0, 1)
    places = np.stack([first, np.clip(shares[1], 0, 1 - first)], axis=-1).astype(np.float32).astype(np.float64)
    places[file.listed] = file.barycentrics
    return np.maximum(places, 0)


def one_sided(file: Record) -> Array:
    """5.6: [N] bool."""
    bits = np.zeros(0, np.uint8) if file.one_sided is None else file.one_sided
    return np.resize(np.unpackbits(bits, bitorder="little").astype(bool), len(file.texels))


def coarser(fine: Texels, blocks: Array, mean_vertices: Array) -> Texels:
    """9.1 to 9.3: the next level."""
    row, column = np.divmod(fine.texels, fine.size)
    texels, block = np.unique(row // 2 * (fine.size // 2) + column // 2, return_inverse=True)  # 9.1
    number = blocks[block] >> 2 * (2 * (row % 2) + column % 2) & 3  # 9.2
    chief = np.flatnonzero(number == 3)[np.argsort(block[number == 3])]

    def mean(values: Array, counted: Array) -> Array:
        total = [np.bincount(block, value * counted, len(texels)) for value in values]
        return np.array(total) / np.bincount(block, counted, len(texels))

    member = number > 0
    static = mean(fine.static_offset, member)  # 9.3
    s = np.einsum("nk,nkx->xn", fine.weights(), mean_vertices[fine.corners])
    static[0:3] = mean(s + fine.static_offset[0:3], member) - s[:, chief]
    static[3:7] = mean(fine.static_offset[3:7], number >= 2)
    static[7:10] += 0.5 * np.log2(np.bincount(block, member)) * np.log(1.85)
    sided = mean(~fine.one_sided[None], member)[0] == 0
    places = fine.triangles[chief], fine.barycentrics[chief], sided, static, fine.corners[chief]
    return Texels(fine.size // 2, texels, *places)


def texel_length(avatar: Record) -> float:
    """9.5: metres."""
    a, b, c = avatar.coarse.mean[avatar.template.faces].swapaxes(0, 1)
    return float(np.sqrt(np.linalg.norm(np.cross(b - a, c - a), axis=-1).sum() / 2 / len(avatar.texels.texels)))
