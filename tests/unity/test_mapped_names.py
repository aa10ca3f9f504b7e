"""Names of expressions in C# mean what they mean in the package, and move as much of one another."""

from pathlib import Path

import numpy as np
from csharp import PROGRAMS, RUNTIME, CSharp
from expression_sets import pairs

from mua.pose.expression_names import match_expressions


def test_names_match_as_in_the_package(csharp: CSharp, tmp_path: Path) -> None:
    file = csharp.build([RUNTIME / "Format"], library=True)
    motion = csharp.build([RUNTIME / "Motion"], library=True, references=[file])
    program = csharp.build([PROGRAMS / "NamesProgram.cs"], references=[file, motion])
    lines = tmp_path / "names.txt"
    lines.write_text("\n".join("\t".join(names) if names else "none" for pair in pairs() for names in pair), "utf-8")
    answers = csharp.run(program, lines).splitlines()
    assert len(answers) == len(pairs())
    for (avatar, source), answer in zip(pairs(), answers, strict=True):
        found = np.array(answer.split(), np.float32).reshape(len(avatar), len(source))
        np.testing.assert_array_equal(found, match_expressions(avatar, source), f"{avatar} {source}")
