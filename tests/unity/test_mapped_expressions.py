"""Expressions in C#: names mean what they mean in the package, and rules leave of weights what they leave there."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from csharp import PROGRAMS, RUNTIME, CSharp
from expression_sets import pairs
from rule_cases import cases

from mua.pose.expression_names import match_expressions
from mua.pose.expression_rules import held_back


@pytest.fixture
def program(csharp: CSharp) -> Path:
    file = csharp.build([RUNTIME / "Format"], library=True)
    motion = csharp.build([RUNTIME / "Motion"], library=True, references=[file])
    return csharp.build([PROGRAMS / "ExpressionsProgram.cs"], references=[file, motion])


def answers(csharp: CSharp, program: Path, what: str, file: Path, lines: Sequence[str]) -> list[list[str]]:
    file.write_text("\n".join(lines), "utf-8")
    return [answer.split() for answer in csharp.run(program, what, file).splitlines()]


def test_names_match_as_in_the_package(csharp: CSharp, program: Path, tmp_path: Path) -> None:
    lines = ["\t".join(names) if names else "none" for pair in pairs() for names in pair]
    found = answers(csharp, program, "names", tmp_path / "names.txt", lines)
    for (avatar, source), answer in zip(pairs(), found, strict=True):
        shares = np.array(answer, np.float32).reshape(len(avatar), len(source))
        np.testing.assert_array_equal(shares, match_expressions(avatar, source), f"{avatar} {source}")


def test_rules_leave_what_they_leave_in_the_package(csharp: CSharp, program: Path, tmp_path: Path) -> None:
    lines = [" ".join(map(str, values.tolist())) for case in cases() for values in case]
    found = answers(csharp, program, "rules", tmp_path / "rules.txt", lines)
    for (rules, weights), answer in zip(cases(), found, strict=True):
        np.testing.assert_allclose(np.array(answer, np.float32), held_back(rules, weights), rtol=0, atol=2.0**-24)
