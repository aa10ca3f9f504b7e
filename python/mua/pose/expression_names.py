"""Which expressions of an avatar the expressions of a motion or a tracker move, and how much.

A name moves its own expression where the avatar has it: the same name, else the same expression in another spelling.
Otherwise it moves what comes nearest among the avatar's: ARKit's jawOpen moves VRM's aa, VRM's blink moves both
eyelids of ARKit.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from mua.arrays import Array
from mua.pose.expression_vocabulary import ARKIT, VISEMES, VRM, is_own_spelling, known_expression

Weights = Mapping[str, float]


def _both(name: str, weight: float) -> dict[str, float]:
    """Both sides of one of ARKit's expressions."""
    return {f"{name}Left": weight, f"{name}Right": weight}


_SOUNDS: Mapping[str, Weights] = {  # a mouth's shape in ARKit's expressions
    "aa": {"jawOpen": 0.7},
    "ih": {"jawOpen": 0.2, **_both("mouthStretch", 0.5), **_both("mouthLowerDown", 0.3)},
    "ou": {"jawOpen": 0.15, "mouthPucker": 0.8, "mouthFunnel": 0.4},
    "ee": {"jawOpen": 0.25, **_both("mouthSmile", 0.3), **_both("mouthStretch", 0.4)},
    "oh": {"jawOpen": 0.4, "mouthFunnel": 0.7},
    "PP": {**_both("mouthPress", 0.5), "mouthRollLower": 0.3, "mouthRollUpper": 0.3},
    "FF": {"jawOpen": 0.05, "mouthRollLower": 0.6, **_both("mouthUpperUp", 0.3)},
    "TH": {"jawOpen": 0.2, "tongueOut": 0.3},
    "DD": {"jawOpen": 0.15, **_both("mouthLowerDown", 0.3)},
    "kk": {"jawOpen": 0.2, **_both("mouthStretch", 0.2)},
    "CH": {"jawOpen": 0.1, "mouthFunnel": 0.5},
    "SS": {"jawOpen": 0.05, **_both("mouthStretch", 0.4)},
    "nn": {"jawOpen": 0.15, **_both("mouthStretch", 0.1)},
    "RR": {"jawOpen": 0.2, "mouthFunnel": 0.4},
}
_VOWELS = {"aa": "aa", "ih": "ih", "ou": "ou", "ee": "E", "oh": "oh"}  # VRM's name, Oculus'

# For each expression, sets of others that stand for it; the first of which an avatar has any is taken.
_VRM_BY_OTHERS: Mapping[str, Sequence[Weights]] = {
    **{vowel: ({f"viseme_{sound}": 1.0}, _SOUNDS[vowel]) for vowel, sound in _VOWELS.items()},
    "happy": ({**_both("mouthSmile", 0.8), **_both("cheekSquint", 0.5)},),
    "angry": ({**_both("browDown", 1.0), **_both("noseSneer", 0.3), **_both("mouthFrown", 0.3)},),
    "sad": ({"browInnerUp": 0.8, **_both("mouthFrown", 0.8)},),
    "relaxed": ({**_both("mouthSmile", 0.4), **_both("eyeSquint", 0.3)},),
    "surprised": ({"browInnerUp": 0.8, **_both("browOuterUp", 1.0), **_both("eyeWide", 1.0), "jawOpen": 0.3},),
    "neutral": (),
    "blink": (_both("blink", 1.0), _both("eyeBlink", 1.0)),
    "blinkLeft": ({"eyeBlinkLeft": 1.0}, {"blink": 0.5}),
    "blinkRight": ({"eyeBlinkRight": 1.0}, {"blink": 0.5}),
    "lookUp": (_both("eyeLookUp", 1.0),),
    "lookDown": (_both("eyeLookDown", 1.0),),
    "lookLeft": ({"eyeLookOutLeft": 1.0, "eyeLookInRight": 1.0},),
    "lookRight": ({"eyeLookInLeft": 1.0, "eyeLookOutRight": 1.0},),
}
_VISEMES_BY_OTHERS: Mapping[str, Sequence[Weights]] = {
    "viseme_sil": (),
    **{f"viseme_{sound}": ({vowel: 1.0}, _SOUNDS[vowel]) for vowel, sound in _VOWELS.items()},
    "viseme_PP": (_SOUNDS["PP"],),  # no vowel has closed lips
    "viseme_FF": (_SOUNDS["FF"], {"ih": 0.2}),
    "viseme_TH": (_SOUNDS["TH"], {"ih": 0.3}),
    "viseme_DD": (_SOUNDS["DD"], {"ih": 0.4}),
    "viseme_kk": (_SOUNDS["kk"], {"ih": 0.3}),
    "viseme_CH": (_SOUNDS["CH"], {"ou": 0.4}),
    "viseme_SS": (_SOUNDS["SS"], {"ih": 0.4}),
    "viseme_nn": (_SOUNDS["nn"], {"ih": 0.3}),
    "viseme_RR": (_SOUNDS["RR"], {"ou": 0.4}),
}
_HALVES = {
    **{"mouthSmile": "happy", "mouthFrown": "sad", "browDown": "angry", "eyeWide": "surprised"},
    **{"eyeLookUp": "lookUp", "eyeLookDown": "lookDown"},
}
_ARKIT_BY_OTHERS: Mapping[str, Sequence[Weights]] = {
    **dict.fromkeys(ARKIT, ()),  # what no preset shows: a puffed cheek, a jaw to the side
    **{f"{name}{side}": ({mood: 0.5},) for name, mood in _HALVES.items() for side in ("Left", "Right")},
    **{f"eyeBlink{side}": ({f"blink{side}": 1.0}, {"blink": 0.5}) for side in ("Left", "Right")},
    **{name: ({"lookLeft": 0.5},) for name in ("eyeLookOutLeft", "eyeLookInRight")},
    **{name: ({"lookRight": 0.5},) for name in ("eyeLookInLeft", "eyeLookOutRight")},
    "jawOpen": ({"aa": 1.0}, {"viseme_aa": 1.0}),
    "mouthClose": ({"aa": -1.0}, {"viseme_aa": -1.0}),  # the lips closed over a jaw that is open
    "mouthFunnel": ({"oh": 1.0}, {"viseme_oh": 1.0}),
    "mouthPucker": ({"ou": 1.0}, {"viseme_ou": 1.0}),
    **{f"mouthStretch{side}": ({"ih": 0.5}, {"viseme_ih": 0.5}) for side in ("Left", "Right")},
    **{name: ({"viseme_PP": 0.5},) for name in ("mouthPressLeft", "mouthPressRight")},
    "tongueOut": ({"viseme_TH": 1.0},),
}
BY_OTHERS = {**_VRM_BY_OTHERS, **_VISEMES_BY_OTHERS, **_ARKIT_BY_OTHERS}
_VOCABULARIES = (VRM, VISEMES, ARKIT)  # where a source has several, an expression follows the first


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
    row_of = _rows(names_of_avatar)
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


def _rows(names: Sequence[str]) -> dict[str, int]:
    """The row of each known expression among an avatar's; one in its own spelling goes before one of like meaning."""
    rows: dict[str, int] = {}
    for row in sorted(range(len(names)), key=lambda row: not is_own_spelling(names[row])):
        known = known_expression(names[row])
        if known is not None:
            rows.setdefault(known, row)
    return rows


def _nearest(name: str, row_of: Mapping[str, int]) -> dict[str, float]:
    """What an avatar has of the first set that stands for an expression."""
    for weights in BY_OTHERS[name]:
        there = {other: weight for other, weight in weights.items() if other in row_of}
        if there:
            return there
    return {}
