"""Which expressions hold others back, and which are switches: section 12.6 of schemas/README.md.

Rules of a face are a number for each expression, as a file stores them: two bits each for blinks, looks and mouths, one
for switches. What they mean is VRM's:
https://github.com/vrm-c/vrm-specification/blob/master/specification/VRMC_vrm-1.0/expressions.md
Browsers and Unity follow them alike: python/mua/web/rules.js, unity-package/Runtime/Motion/ExpressionRules.cs.
"""

from collections.abc import Mapping, Sequence, Set

import numpy as np

from mua.arrays import Array

LOOKS = ("lookUp", "lookDown", "lookLeft", "lookRight")
KINDS = {"blink": ("blink", "blinkLeft", "blinkRight"), "look": LOOKS, "mouth": ("aa", "ih", "ou", "ee", "oh")}
HOLDS = {"block": 1, "blend": 2}  # a kind, while the expression shows or by its weight
OF_KIND = 3
SWITCH = 1 << 2 * len(KINDS)
THRESHOLD = 0.5  # above which a switch shows


def rules_of(
    names: Sequence[str],  # [E]
    switched: Set[str],
    overrides: Mapping[str, Mapping[str, str]],  # expression to kinds that it holds back: "block" or "blend"
    looks: Sequence[str] = LOOKS,  # those that show a gaze
) -> Array | None:
    """The rules [E] int32 of expressions; None where none is a switch or holds anything back."""
    rules, kinds = np.zeros(len(names), np.int32), KINDS | {"look": looks}
    if not any(name in switched or overrides.get(name) for name in names):
        return None
    for row, name in enumerate(names):
        held = overrides.get(name, {})
        for number, (kind, own) in enumerate(kinds.items()):
            rules[row] |= (OF_KIND if name in own else HOLDS.get(held.get(kind, ""), 0)) << 2 * number
        rules[row] |= SWITCH * (name in switched)
    return rules


def held_back(
    rules: Array | None,  # [E] int32; None: all 0
    weights: Array,  # [..., E] 0 to 1
) -> Array:
    """The weights [..., E] that show."""
    if rules is None:
        return weights
    switched, given = rules & SWITCH != 0, weights.astype(np.float64)
    own = np.where(switched, given > THRESHOLD, given)
    shown = own.copy()
    for number in range(len(KINDS)):
        role = rules >> 2 * number & OF_KIND
        amounts = np.where(role == HOLDS["block"], own > 0, np.where(role == HOLDS["blend"], own, 0))
        held = np.minimum(amounts.sum(axis=-1, keepdims=True), 1)
        left = np.where(switched, held == 0, 1 - held)
        shown = np.where(role == OF_KIND, shown * left, shown)
    return shown.astype(weights.dtype)
