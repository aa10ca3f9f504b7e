"""How much finer the texels of a body part are than elsewhere."""

from collections.abc import Mapping, Sequence
from typing import Literal, TypeAlias

import numpy as np

from mua.arrays import Array, unique_rows
from mua.errors import InputError
from mua.rig.body_parts import BODY_PARTS, BodyPart

UvMode: TypeAlias = Literal["keep", "unwrap", "auto"]  # what becomes of the UVs of a file
Detail = Mapping[BodyPart, float]  # texels along a metre, over those of a part that is not named

BY_DEFAULT: Detail = {"head": 2.3, "hands": 1.5}
LARGEST_SHARES: Detail = {"head": 0.45, "hands": 0.15}  # of all texels: a big head, or what a hand holds, is seen as is
FINEST = 8.0  # and the coarsest is 1 / FINEST
PIECE = 0.003  # of the surface: a smaller piece of a chart is not worth a border of its own


def read_detail(texts: Sequence[str], *, uv: str) -> dict[BodyPart, float]:
    """Parse `head=2` and the like; raises an InputError for an unknown part, a factor out of bounds, or kept UVs."""
    if texts and uv == "keep":
        raise InputError(f"--detail {texts[0]}: --uv keep leaves all texels as they are, expected auto or unwrap")
    found: dict[BodyPart, float] = {}
    for text in texts:
        part, equals, factor = text.partition("=")
        if not equals or part not in BODY_PARTS:
            raise InputError(f"--detail {text}: expected a part and a factor such as head=2, parts: {_listed()}")
        try:
            value = float(factor)
        except ValueError:
            value = np.nan
        if not 1 / FINEST <= value <= FINEST:
            raise InputError(f"--detail {text}: the factor is {factor!r}, expected {1 / FINEST:g} to {FINEST:g}")
        if part in found:
            raise InputError(f"--detail {text}: {part} is named more than once")
        found[part] = value
    return found


def factors(
    parts: Array,  # [F] into BODY_PARTS
    surface: Array,  # [F] m2
    detail: Detail,
) -> tuple[Array, tuple[str, ...]]:
    """How much finer in length [F] each triangle is to be drawn, and a sentence for each part that is not there."""
    area = np.bincount(parts, surface, minlength=len(BODY_PARTS))
    by_part = np.ones(len(BODY_PARTS))
    for part in BY_DEFAULT:
        k = BODY_PARTS.index(part)
        by_part[k] = by_default(part, area[k] / area.sum()) if area[k] else 1.0
    absent = []
    for part, factor in detail.items():
        k = BODY_PARTS.index(part)
        by_part[k] = factor
        if area[k] == 0:
            absent.append(f"--detail {part}={factor:g} changes nothing: no joint of the {part} was recognised.")
    return by_part[parts], tuple(absent)


def by_default(part: BodyPart, share: float) -> float:
    """How much finer in length a part that has this share of the surface is drawn where nobody asks for it."""
    most = LARGEST_SHARES[part]
    largest = np.sqrt(most / (1 - most) * (1 - share) / share)  # then it takes the share `most` of the texels
    return float(min(BY_DEFAULT[part], max(largest, 1.0)))


def split_by_factor(
    nodes: Array,  # [F, 3] int, equal where corners share vertex, UV and material
    corners: Array,  # [F, 3, 2] UV
    *,
    charts: Array,  # [F]
    surface: Array,  # [F] m2
    finer: Array,  # [F]
) -> tuple[Array, Array]:
    """Cut charts along the borders of parts that are drawn at different scales.

    A piece that is too small for borders of its own takes the scale of most of its chart. Returns the charts [F],
    numbered from 0, and the factor [F] of each triangle, one for all of a chart.
    """
    charts = np.unique(charts, return_inverse=True)[1]
    levels, level = np.unique(finer, return_inverse=True)
    piece = _pieces(nodes, corners, np.stack([charts, level], axis=1))
    small = np.bincount(piece, surface)[piece] < PIECE * surface.sum()
    area = np.zeros((charts.max() + 1, len(levels)))
    np.add.at(area, (charts, level), surface)
    level = np.where(small, area.argmax(axis=1)[charts], level)
    return _pieces(nodes, corners, np.stack([charts, level], axis=1)), levels[level]


def _pieces(nodes: Array, corners: Array, labels: Array) -> Array:
    """Number the parts of charts [F] whose triangles hang together and share both labels [F, 2]."""
    from mua.rig.charts import find_charts  # here, because options are read without scipy

    rows = np.column_stack([np.repeat(labels, 3, axis=0), nodes.ravel()])
    return find_charts(unique_rows(rows)[2].reshape(-1, 3), corners)


def _listed() -> str:
    return ", ".join(BODY_PARTS)
