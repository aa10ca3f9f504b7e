"""Faults are put where behaviour hangs, one place at a time, and nowhere else."""

from pathlib import Path

import pytest
from mutant_python import python_mutants
from mutant_sites import Mutant, arguments, mutants, text_mutants


def becomes(name: str, text: str) -> set[tuple[str, str]]:
    """Operator and text of every fault of a line of code."""
    found = python_mutants(name, text) if name.endswith(".py") else text_mutants(name, text)
    return {(mutant.operator, mutant.apply(text)) for mutant in found}


@pytest.mark.parametrize(
    ("line", "operator", "mutated"),
    [
        ("a < b", "boundary", "a <= b"),
        ("a is b", "boundary", "a is not b"),
        ("(a) + b", "sign", "(a) - b"),
        ("-(a + b)", "sign", "(a + b)"),
        ("a += b", "sign", "a -= b"),
        ("a = 7", "constant", "a = 8"),
        ("a = 0.25", "constant", "a = 0.5"),
        ("a = True", "constant", "a = False"),
        ("a and b", "logic", "a or b"),
        ("not a", "logic", "a"),
        ("f(a)", "dropped call", "pass"),
        ("b = np.sqrt(a)", "dropped call", "b = (a)"),
        ("b = f(a, c)", "swapped argument", "b = f(c, a)"),
        ("a @ b", "swapped argument", "b @ a"),
    ],
)
def test_every_operator_changes_python(line: str, operator: str, mutated: str) -> None:
    assert (operator, mutated) in becomes("a.py", line)


@pytest.mark.parametrize(
    "line",
    [
        '"""Says 3 + 4."""',
        "# 3 < 4",
        'raise InputError("at most 3", 4 + 5)',
        'print("a", 3)',
        'f"{a + 1}"',
        "def f(a: Array[3, 4]) -> Array[5, 6]: ...",
        "if TYPE_CHECKING:\n    a = 3",
        "a = 1e-9",
        "b = max(a, c)",
        "zip(strict=True)",
    ],
)
def test_nothing_is_changed_that_python_only_says(line: str) -> None:
    assert {mutated for operator, mutated in becomes("a.py", line) if operator != "dropped call"} == set()


@pytest.mark.parametrize(
    ("line", "operator", "mutated"),
    [
        ("{ a = b < c; }", "boundary", "{ a = b <= c; }"),
        ("{ a = b - c; }", "sign", "{ a = b + c; }"),
        ("{ return -b; }", "sign", "{ return b; }"),
        ("{ a *= b; }", "sign", "{ a /= b; }"),
        ("{ a = 0.5f; }", "constant", "{ a = 1.0f; }"),
        ("{ a = b[3]; }", "constant", "{ a = b[4]; }"),
        ("{ a = b && !c; }", "logic", "{ a = b || !c; }"),
        ("{ a = b && !c; }", "logic", "{ a = b && c; }"),
        ("{ GroupBarrier(); }", "dropped call", "{ ; }"),
        ("{ a = max(b, 0.5); }", "dropped call", "{ a = (b); }"),
        ('{ a = F("x", b, G(c, d)); }', "swapped argument", '{ a = F("x", G(c, d), b); }'),
        ('{ a = F(b + "x", c); }', "swapped argument", '{ a = F(c, b + "x"); }'),
        ('{ a = F("x", b, G(c, d)); }', "swapped argument", '{ a = F("x", b, G(d, c)); }'),
    ],
)
@pytest.mark.parametrize("name", ["a.cs", "a.hlsl"])
def test_every_operator_changes_text(name: str, line: str, operator: str, mutated: str) -> None:
    assert (operator, mutated) in becomes(name, line)


@pytest.mark.parametrize(
    "line",
    [
        "// 3 < 4",
        "/* a + b */",
        '{ a = "b < c" + d; }',
        "#define A 3",
        "[numthreads(8, 4, 1)]",
        '{ throw new E("at most " + 3, a < b); }',
        "float f(float a, float b);",
        "List<int> a;",
        "{ a = 0xff; }",
        "{ a = 1e-38; }",
    ],
)
def test_nothing_is_changed_that_text_only_says(line: str) -> None:
    assert becomes("a.cs", line) == set()


def test_only_the_programs_of_a_shader_file_are_changed() -> None:
    text = 'Pass\n{\n    Offset 1 , 2\n    HLSLPROGRAM\n    int a = 3;\n    ENDHLSL\n    Name "b" + 1\n}\n'
    assert [mutant.lines(text) for mutant in text_mutants("a.shader", text)] == [(5, "int a = 3;", "int a = 4;")]


def test_the_room_of_a_shaders_array_is_left_alone() -> None:
    assert becomes("a.hlsl", "float4 f(float3 rows[3])") == set()
    assert becomes("a.hlsl", "{ a = rows[3]; }") == {("constant", "{ a = rows[4]; }")}


def test_a_python_fault_knows_the_function_about_it() -> None:
    text = "A = 1\nclass B:\n    c = 2\n    def d(self):\n        def e():\n            return 3\n        return e\n"
    assert [mutant.scope for mutant in python_mutants("a.py", text)] == ["", "", "B.d"]


def test_letters_beyond_ascii_do_not_shift_a_fault() -> None:
    assert [mutant.apply('a = "é", 1') for mutant in python_mutants("a.py", 'a = "é", 1')] == ['a = "é", 2']


def test_arguments_end_at_their_own_bracket() -> None:
    code = "f(a, g(b, c)[d, e], h)(i)"
    assert [code[part.start : part.stop] for part in arguments(code, 1, code)] == ["a", "g(b, c)[d, e]", "h"]
    assert arguments("f( )", 1, "f( )") == []


def test_a_fault_over_several_lines_is_told_in_one() -> None:
    text = "f(\n    a,\n    b,\n)\n"
    assert Mutant("a.py", "swapped argument", 7, 15, "b,\n    a").lines(text) == (2, "a, b,", "b, a,")


def test_generated_files_are_left_alone(tmp_path: Path) -> None:
    (tmp_path / "a.cs").write_text("// Generated from b; do not edit.\nint a = 3;\n")
    assert mutants(tmp_path / "a.cs", tmp_path) == []
