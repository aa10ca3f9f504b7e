"""Which expressions of an avatar the expressions of a motion or a tracker move, and how much.

A name moves its own expression where the avatar has it: the same name, else the same expression in another spelling.
Otherwise it moves what comes nearest among the avatar's: ARKit's jawOpen moves VRM's aa, VRM's blink moves both
eyelids of ARKit. What stands in for what is data, expression_names.json; browsers and Unity match by the same table:
python/mua/web/names/match.js, unity-package/Runtime/Motion/ExpressionNames.cs.
"""

from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache

import numpy as np

from mua.arrays import Array
from mua.pose.expression_vocabulary import (
    ARKIT,
    NAMES,
    PAIRS_AND_HALVES,
    VISEMES,
    VRM,
    known_expression,
    likeness,
)

STAND_INS: Mapping[str, Sequence[Mapping[str, float]]] = NAMES["standIns"]
_VOCABULARIES = (VRM, VISEMES, ARKIT, PAIRS_AND_HALVES)  # where a source has several, an expression follows the first
_SIDED = {*ARKIT, *PAIRS_AND_HALVES}


def stand_ins(name: str) -> Iterator[Mapping[str, float]]:
    """Sets of expressions that stand for one, of which the first counts that an avatar has any of.

    Of ARKit's, their pairs and halves, both sides stand for both as one, and half of that for a side, before others.
    """
    whole = name.removesuffix("Left").removesuffix("Right")
    for sided in ({f"{name}Left": 1.0, f"{name}Right": 1.0}, {whole: 0.5}):
        if _SIDED.issuperset(sided):
            yield sided
    yield from STAND_INS.get(name, ())


def match_expressions(
    names_of_avatar: Sequence[str],  # E
    source_names: Sequence[str],  # S
) -> Array:
    """How much [E, S] each expression of a source moves each of an avatar.

    The avatar's weights [E] are clip(result @ weights of the source [S], 0, 1).
    Entries are 1 for the same expression; shares, which may be negative, where another stands for it. A source that
    moves its own expression moves no other, and an expression that its own source moves follows no other.
    """
    matrix = np.zeros((len(names_of_avatar), len(source_names)), np.float32)
    row_of = rows_of(names_of_avatar)
    exact = {name: row for row, name in enumerate(names_of_avatar)}
    direct = [exact.get(name, row_of.get(known_expression(name) or "")) for name in source_names]
    own = {row for row in direct if row is not None}
    stand_ins: dict[int, dict[int, list[tuple[int, float]]]] = {}  # row, vocabulary: columns and weights
    for column, (name, row) in enumerate(zip(source_names, direct, strict=True)):
        if row is not None:
            matrix[row, column] = 1
            continue
        known = known_expression(name)
        for other, weight in _nearest(known, row_of).items() if known else ():
            if row_of[other] not in own:
                vocabulary = next(v for v, names in enumerate(_VOCABULARIES) if known in names)
                stand_ins.setdefault(row_of[other], {}).setdefault(vocabulary, []).append((column, weight))
    for row, by_vocabulary in stand_ins.items():
        for column, weight in by_vocabulary[min(by_vocabulary)]:
            matrix[row, column] = weight
    return matrix


def set_weights(
    names_of_avatar: Sequence[str],  # E
    named: Mapping[str, float],
) -> dict[str, float]:
    """The weights, held to 0 to 1, of an avatar's expressions that follow weights given by whatever names."""
    matrix = _matched(tuple(names_of_avatar), tuple(named))
    found = np.clip(matrix @ np.array([*named.values()], float), 0, 1)
    return {name: float(found[row]) for row, name in enumerate(names_of_avatar) if matrix[row].any()}


_matched = lru_cache(maxsize=256)(match_expressions)  # whoever sets weights sets them frame by frame


def rows_of(names: Sequence[str]) -> dict[str, int]:
    """The row of each known expression among an avatar's: of several names for it, that of the nearest."""
    rows: dict[str, int] = {}
    for row in sorted(range(len(names)), key=lambda row: likeness(names[row])):
        known = known_expression(names[row])
        if known is not None:
            rows.setdefault(known, row)
    return rows


def _nearest(name: str, row_of: Mapping[str, int]) -> dict[str, float]:
    """What an avatar has of the first set that stands for an expression."""
    for weights in stand_ins(name):
        there = {other: weight for other, weight in weights.items() if other in row_of}
        if there:
            return there
    return {}
