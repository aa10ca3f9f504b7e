"""What shows of weights of expressions: what holds others back, and switches."""

from types import SimpleNamespace

import numpy as np
from oracle import expressions
from rule_cases import cases

from mua.pose.expression_rules import held_back, rules_of

NAMES = ("happy", "sad", "blink", "blinkLeft", "lookUp", "aa", "cheekPuff")


def shown(*switched: str, overrides: dict[str, dict[str, str]] | None = None, **weights: float) -> dict[str, float]:
    """What shows of some weights, those that are not 0."""
    found = held_back(
        rules_of(NAMES, {*switched}, overrides or {}), np.array([weights.get(name, 0.0) for name in NAMES])
    )
    return {name: round(float(weight), 6) for name, weight in zip(NAMES, found, strict=True) if weight}


def test_without_rules_all_shows() -> None:
    assert rules_of(NAMES, frozenset(), {"elsewhere": {"blink": "block"}, "happy": {}}) is None
    assert shown(happy=0.4, blink=0.6, aa=1) == {"happy": 0.4, "blink": 0.6, "aa": 1}


def test_an_expression_holds_others_back_wholly_or_by_its_weight() -> None:
    overrides = {"happy": {"blink": "block", "mouth": "blend"}, "sad": {"mouth": "blend"}}
    moved = {"blink": 0.8, "blinkLeft": 1.0, "aa": 0.5, "lookUp": 1.0, "cheekPuff": 1.0}
    held = {"happy": 0.25, "aa": 0.375, "lookUp": 1, "cheekPuff": 1}
    assert shown(overrides=overrides, happy=0.25, **moved) == held
    assert shown(overrides=overrides, **moved) == moved
    together = shown(overrides=overrides, happy=0.5, sad=0.75, aa=1)
    assert together == {"happy": 0.5, "sad": 0.75}  # no more than all
    look = {"happy": {"look": "blend"}}
    assert shown(overrides=look, happy=0.5, lookUp=1, blink=1) == {"happy": 0.5, "lookUp": 0.5, "blink": 1}


def test_an_expression_does_not_hold_back_its_own_kind() -> None:
    overrides = {"blinkLeft": {"blink": "block", "mouth": "block"}}
    assert shown(overrides=overrides, blinkLeft=1, blink=0.5, aa=1) == {"blinkLeft": 1, "blink": 0.5}


def test_a_switch_shows_wholly_above_a_half_and_holds_back_as_it_shows() -> None:
    overrides = {"happy": {"blink": "blend"}}
    assert shown("happy", overrides=overrides, happy=0.5, blink=1) == {"blink": 1}
    assert shown("happy", overrides=overrides, happy=0.51, blink=1) == {"happy": 1}


def test_a_switch_that_is_held_back_at_all_does_not_show() -> None:
    overrides = {"happy": {"blink": "blend"}}
    assert shown("blink", overrides=overrides, happy=0.01, blink=1, blinkLeft=1) == {"happy": 0.01, "blinkLeft": 0.99}
    assert shown("blink", overrides=overrides, blink=0.6) == {"blink": 1}


def test_weights_that_were_held_back_would_be_held_back_again() -> None:
    """Why clips hold weights as they were before."""
    overrides = {"happy": {"blink": "blend"}}
    assert shown(overrides=overrides, happy=0.5, blink=1)["blink"] == 0.5
    assert shown(overrides=overrides, happy=0.5, blink=0.5)["blink"] == 0.25


def test_rules_of_any_numbers_leave_what_the_page_says() -> None:
    changed = 0
    for rules, weights in cases():
        found = held_back(rules, weights.astype(np.float64))
        expected = expressions.shown(SimpleNamespace(rules=rules), weights.astype(np.float64))
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-15)
        changed += (found != weights).any()
    assert changed > 250
