"""How fine each triangle is to be drawn, for what its texture shows and for what of it is seen, the face before all.

Within the head, the hands and the rest of the body, the widths of texels are those at which the errors of all triangles
together are least at the same number of texels. Errors are measured on the file's own textures, where an expression
makes a triangle largest.
"""

from collections.abc import Collection

import numpy as np
from scipy.sparse import coo_matrix

from mua.arrays import Array
from mua.atlas.character_surfaces import Surfaces
from mua.atlas.detail import by_default
from mua.atlas.surface_samples import spread_samples, texture_losses
from mua.atlas.visibility import seen_shares
from mua.rig.body_parts import BODY_PARTS
from mua.rig.charts import areas
from mua.rig.growth import largest_areas

TEXELS = 110_000  # of an avatar at 384 texels, for which widths are chosen
OCTAVES = np.arange(-4, 3)  # widths at which losses are measured, of the mean
WIDTHS = 2 ** np.arange(OCTAVES[0], OCTAVES[-1] + 0.01, 0.25)  # that are chosen from
SHAPE = 3e-3  # error of texels of the mean width that show the shape alone, in proportion to the width
USUAL = 0.45  # share of views in which a surface is seen that nothing hides
HIDDEN, LEAST_SEEN = 0.05, 0.1  # share of views below which it counts as hidden, and least weight of its error
FACE, FRONTAL = 3.0, 0.4  # how much finer the face is, and the share of views of the front in which it is seen
FACE_SIZE = 2.0  # standard deviation about the middle of the face, over that of the head seen from the front
LEAST_FINE = {"head": 0.35, "hands": 0.7, "body": 0.7}  # of the mean, in length; for hidden surface HIDDEN_FINE of it
HIDDEN_FINE = 0.7
PLAIN, PLAIN_FINE = 1e-5, 0.87  # loss of a head's texture below which it shows nothing, and how much coarser it then is
MOST_GROWTH = 4.0  # in length, that expressions count for
SMOOTHING = 3  # rounds over neighbours
HALVINGS = 30  # of the range in which the price of a texel is sought
DEAREST = 2.0**10  # and the cheapest is 2^-60: such prices give the widest and the narrowest texels
TINY = np.finfo(float).tiny


def wanted_fineness(
    surfaces: Surfaces,
    corners: Array,  # [F, 3, 2] UV of the file
    *,
    parts: Array,  # [F] into BODY_PARTS
    chosen: Collection[str] = (),  # parts whose fineness somebody asked for
) -> Array:
    """How many times finer in length than the mean of its part each triangle [F] is to be drawn.

    A head of one colour gives some of its texels to the rest of the figure, unless its fineness was asked for.
    """
    positions = surfaces.vertices[surfaces.faces]
    surface, samples = areas(positions), spread_samples(positions)
    mean = np.sqrt(surface.sum() / TEXELS)
    losses, opacity = texture_losses(surfaces, samples, corners, widths=mean * 2.0**OCTAVES)
    shares = seen_shares(samples.at(positions), _normals(positions)[samples.triangles], opacity)
    seen, front = (samples.means(share, len(surface)) for share in shares)
    nearness = _nearness(positions.mean(axis=1), surface * front * (parts == BODY_PARTS.index("head")))
    face = 1 + (FACE - 1) * nearness * np.minimum(front / FRONTAL, 1)
    largest = largest_areas(surfaces.expressions, surfaces.vertices, surfaces.faces)
    larger = np.sqrt(np.minimum(largest / np.maximum(surface, TINY), MOST_GROWTH**2))
    # By its cube, since at an error in proportion to the width the best width falls with the cube root of the weight.
    weight = np.maximum(seen / USUAL, LEAST_SEEN) * (face * larger) ** 3
    errors = _smooth((_finely(losses) + SHAPE * WIDTHS) * weight[:, None], surface, surfaces.faces)
    # What lies just behind a face is fine as well: wide splats of the inside of a mouth would shine through the lips.
    least = (1 + (FACE - 1) * nearness) * np.where(seen < HIDDEN, HIDDEN_FINE, 1) * larger
    head = parts == BODY_PARTS.index("head")
    least[head] *= _taken_by_cards(surfaces, surface, head)
    finer = _within_parts(errors, surface, surfaces.faces, least=least, parts=parts)
    if "head" not in chosen and surface @ (head * losses[:, OCTAVES == 0][:, 0]) <= PLAIN * surface[head].sum():
        finer[head] *= PLAIN_FINE
    return finer


def _taken_by_cards(
    surfaces: Surfaces,
    surface: Array,  # [F]
    head: Array,  # [F] bool
) -> float:
    """How much finer in length a head would be drawn without its transparent surface: cards of hair, in many layers."""
    clear = np.array([m.alpha_mode != "opaque" and m.image[..., 3].min() < 255 for m in surfaces.materials], bool)
    solid = np.where(clear[surfaces.face_material], 0, surface)
    if not surface[head].any() or not solid[head].any():
        return 1.0
    with_cards, without = (by_default("head", float(area[head].sum() / area.sum())) for area in (surface, solid))
    return max(without / with_cards, 1.0)


def _within_parts(
    errors: Array,  # [F, w]
    surface: Array,  # [F]
    faces: Array,  # [F, 3]
    *,
    least: Array,  # [F] over LEAST_FINE
    parts: Array,  # [F] into BODY_PARTS
) -> Array:
    """How many times finer than the mean of its part each triangle [F] is for the least error of each part."""
    of_part = [(rows, share) for part, share in LEAST_FINE.items() if surface[rows := _budget(parts) == part].sum() > 0]
    finer = np.ones(len(surface))
    for rows, _ in of_part:
        finer[rows] = 1 / _widths(errors[rows], surface[rows])
    finer = np.exp(_smooth(np.log(finer)[:, None], surface, faces)[:, 0])
    for rows, share in of_part:
        finer[rows] = _even(np.maximum(_even(finer[rows], surface[rows]), share * least[rows]), surface[rows])
    return finer


def _even(finer: Array, surface: Array) -> Array:
    """Such that as many texels are taken as 1 would take everywhere."""
    return np.asarray(finer / np.sqrt(np.average(finer**2, weights=surface)))


def _budget(parts: Array) -> Array:
    """Which part's texels each triangle [F] shares."""
    return np.array([part if part in LEAST_FINE else "body" for part in BODY_PARTS])[parts]


def _nearness(
    middles: Array,  # [F, 3]
    weight: Array,  # [F] surface of the head that is seen from the front
) -> Array:
    """1 in the middle of the face and 0 far from it, [F]; 0 where there is no head."""
    head = weight > 0
    if not head.any():
        return np.zeros(len(middles))
    centre = np.average(middles[head], axis=0, weights=weight[head])
    size = np.sqrt(np.average((middles[head] - centre) ** 2, axis=0, weights=weight[head]))[:2].mean()
    away = np.linalg.norm((middles - centre)[:, :2], axis=1) / max(FACE_SIZE * size, TINY)
    return np.where(head, np.exp(-(away**2) / 2), 0)


def _finely(
    losses: Array,  # [F, octaves]
) -> Array:
    """Losses [F, w] at all WIDTHS, between those at whole octaves."""
    at = np.log2(WIDTHS) - OCTAVES[0]
    low = np.minimum(at.astype(int), len(OCTAVES) - 2)
    logs, part = np.log(losses + np.finfo(np.float32).eps), at - low
    return np.exp((1 - part) * logs[:, low] + part * logs[:, low + 1])


def _widths(
    errors: Array,  # [n, w] of each triangle for its surface
    surface: Array,  # [n]
) -> Array:
    """The widths [n] of WIDTHS with the least error at as many texels as the width 1 would take everywhere."""
    low, high = np.log2(DEAREST) - 70, np.log2(DEAREST)
    for _ in range(HALVINGS):
        price = (low + high) / 2
        widths = WIDTHS[np.argmin(errors + 2**price / WIDTHS**2, axis=1)]
        low, high = (price, high) if (surface / widths**2).sum() > surface.sum() else (low, price)
    return np.asarray(widths)


def _smooth(
    values: Array,  # [F, c]
    surface: Array,  # [F]
    faces: Array,  # [F, 3]
) -> Array:
    """Means of values over neighbours, by their surface."""
    touches = coo_matrix((np.ones(faces.size), (np.repeat(np.arange(len(faces)), 3), faces.ravel()))).tocsr()
    weight = surface[:, None] + surface.mean() * np.finfo(float).eps
    sums = values * weight
    for _ in range(SMOOTHING):
        sums, weight = touches @ (touches.T @ sums), touches @ (touches.T @ weight)
    return np.asarray(sums / np.maximum(weight, TINY))


def _normals(
    positions: Array,  # [F, 3, 3]
) -> Array:
    """Unit normals [F, 3], 0 where there is no area."""
    across = np.cross(positions[:, 1] - positions[:, 0], positions[:, 2] - positions[:, 0])
    return np.asarray(across / np.maximum(np.linalg.norm(across, axis=1, keepdims=True), TINY))
