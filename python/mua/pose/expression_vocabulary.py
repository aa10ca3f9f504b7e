"""What an expression is by its name, in the spellings of ARKit, VRM, Oculus' visemes and of exporters.

The names are data, expression_names.json; tools/gen_expression_names.py makes those of browsers and of Unity from it.
"""

import json
import re
import unicodedata
from pathlib import Path

NAMES = json.loads(Path(__file__).with_name("expression_names.json").read_text(encoding="utf-8"))
ARKIT, VRM, VISEMES = (tuple(NAMES[vocabulary]) for vocabulary in ("arkit", "vrm", "visemes"))  # VRM 1.0's presets
PAIRS_AND_HALVES = tuple(NAMES["pairsAndHalves"])  # both sides of an expression of ARKit as one, or one side of it

_WORD = re.compile(r"[A-Z]+(?=[A-Z][a-z])|[A-Z]?[a-z]+|[A-Z]+|[^\W\d_A-Za-z]+")
_OWNERS = {*NAMES["owners"]}  # words that only say whose an expression is
_SIDE = {"l": "left", "r": "right", "left": "left", "right": "right"}


def _words(name: str) -> list[str]:
    """The words of a name, lower case, less those before it that only say whose it is."""
    own = unicodedata.normalize("NFKC", name).rsplit(".", 1)[-1]
    words = [word.lower() for word in _WORD.findall(own)]
    while len(words) > 1 and words[0] in _OWNERS:
        words = words[1:]
    return words


def _spelt(name: str) -> str:
    """A name in one spelling: a first or last l or r is a side, which comes last."""
    words = _words(name)
    if len(words) > 1 and words[0] in _SIDE:
        words = [*words[1:], words[0]]
    if len(words) > 1:
        words = [*words[:-1], _SIDE.get(words[-1], words[-1])]
    return "".join(words)


_BY_SPELLING = {_spelt(name): name for name in (*ARKIT, *VRM, *VISEMES, *PAIRS_AND_HALVES)}
_BY_OTHER_NAME = {_spelt(other): name for other, name in NAMES["otherNames"].items()}


def known_expression(name: str) -> str | None:
    """The expression of a vocabulary that a name means, in whatever spelling; None for any other.

    VRM 0's presets mean those of VRM 1.0; a vowel alone (aa, E, ih, oh, ou) is VRM's. One side of another name for an
    expression means that side of it.
    """
    spelt = _spelt(name)
    known = _BY_SPELLING.get(spelt) or _BY_OTHER_NAME.get(spelt)
    for side in ("left", "right"):
        if known is None and spelt.endswith(side):
            whole = _BY_OTHER_NAME.get(spelt.removesuffix(side))
            known = _BY_SPELLING.get(_spelt(f"{whole}_{side}")) if whole else None
    return known


def likeness(name: str) -> int:
    """How near a name is to that of its expression: 0 for another spelling of it, 2 for one with the same meaning.

    One more where it has a number: eyeClose_50 is half of eyeClose, and goes behind it.
    """
    return 2 * (_spelt(name) not in _BY_SPELLING) + any(map(str.isdecimal, name.rsplit(".", 1)[-1]))
