"""Sections 4 and 5 of schemas/README.md: networks, subbands and the texture at its valid texels."""

import numpy as np
from oracle.file import Array, Tree


def network(layers: list[Tree], x: Array) -> Array:
    """4.1"""
    for layer in layers[:-1]:
        x = np.maximum(layer["weight"] @ x + layer["bias"], 0)
    return np.asarray(layers[-1]["weight"] @ x + layers[-1]["bias"])


def canonical(coarse: Tree, x: Array) -> Array:
    """4.2: v [V, 3]"""
    return np.asarray(coarse["mean"] + np.tensordot(network(coarse["mlp"], x), coarse["basis"], 1))


def coefficients(branch: Tree, x: Array) -> list[Array]:
    """4.3: alpha [C, R], then alpha_b [C, R_b]."""
    y, channels = network(branch["mlp"], x), branch["ll_basis"].shape[0]
    found, at = [], 0
    for rank in (branch["ll_basis"].shape[1], *(band["h"].shape[2] for band in branch["details"])):
        found.append(y[at : at + channels * rank].reshape(channels, rank))
        at += channels * rank
    return found


def low(branch: Tree, alpha: Array) -> Array:
    """5.1: LL [C, n, n]"""
    return np.asarray(branch["ll_mean"] + np.einsum("cr,crij->cij", alpha, branch["ll_basis"]))


def detail(band: Tree, alpha: Array) -> Array:
    """5.1: D_b [3, C, n, n]"""
    return np.asarray(band["mean"] + np.einsum("cr,scri,scrj->scij", alpha, band["h"], band["w"]))


def up(taps: Array, a: Array, axis: int) -> Array:
    """5.2: twice as many samples along an axis."""
    a = np.moveaxis(a, axis, 0)
    made = np.zeros((2 * len(a), *a.shape[1:]))
    for k in range(len(a)):
        for q, tap in enumerate(taps):
            made[(2 * k + q - len(taps) // 2 + 1) % len(made)] += tap * a[k]
    return np.moveaxis(made, 0, axis)


def image(avatar: Tree, branch: Tree, x: Array) -> Array:
    """5.2: A of the last level [C, size, size]."""
    lo, hi, alphas = avatar["wavelet"]["rec_lo"], avatar["wavelet"]["rec_hi"], coefficients(branch, x)
    A = low(branch, alphas[0])
    for b in range(avatar["wavelet"]["levels"]):
        made = up(lo, up(lo, A, 2), 1)
        if b < len(branch["details"]):
            first, second, third = detail(branch["details"][b], alphas[b + 1])
            made += up(hi, up(lo, first, 2), 1) + up(lo, up(hi, second, 2), 1) + up(hi, up(hi, third, 2), 1)
        A = made
    return A


def halved(A: Array) -> Array:
    """9.4"""
    return np.asarray((A[:, ::2, ::2] + A[:, ::2, 1::2] + A[:, 1::2, ::2] + A[:, 1::2, 1::2]) / 4)


def at_texels(avatar: Tree, branch: Tree, A: Array) -> Array:
    """5.3: T [C, N]"""
    e, size = avatar["texels"]["texels"], avatar["texels"]["size"]
    return np.asarray(A[:, e // size, e % size] + branch["static_offset"])


def places(avatar: Tree) -> Array:
    """5.5: b_0 and b_1 [N, 2]."""
    texels, template = avatar["texels"], avatar["template"]
    if "listed" not in texels:
        return np.maximum(texels["barycentrics"], 0)
    found, size = np.zeros((len(texels["texels"]), 2)), texels["size"]
    for e, (texel, triangle) in enumerate(zip(texels["texels"], texels["triangles"], strict=True)):
        centre = np.array([texel % size + 0.5, texel // size + 0.5])
        (x0, y0), (x1, y1), (x2, y2) = template["uv"][template["uv_faces"][triangle]] * float(size) - centre
        area0, area1, area2 = x1 * y2 - y1 * x2, x2 * y0 - y2 * x0, x0 * y1 - y0 * x1
        whole = area0 + area1 + area2
        if whole != 0:
            found[e, 0] = np.float32(np.clip(area0 / whole, 0, 1))
            found[e, 1] = np.float32(np.clip(area1 / whole, 0, 1 - found[e, 0]))
    found[texels["listed"]] = texels["barycentrics"]
    return np.maximum(found, 0)


def one_sided(texels: Tree) -> Array:
    """5.6: [N]"""
    e = np.arange(len(texels["texels"]))
    return texels["one_sided"][e // 8] >> e % 8 & 1 == 1 if "one_sided" in texels else np.zeros(len(e), bool)
