"""Places of a source where one small fault can be put: Python by its syntax tree, C# and HLSL by their text.

Operators: `boundary` (< to <=, == to !=), `sign` (+ to -, * to /, a minus dropped), `constant` (one more, twice as
much, true to false), `logic` (and to or, a negation dropped), `dropped call` (a statement, or a function that then
returns what it is given), `swapped argument` (two that stand side by side). Not touched, because no behaviour hangs on
it: comments, annotations, attributes, texts, what is raised, printed or said on help pages.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from shader_source import closing

COMPARED = {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "=="}
SIGNED = {"+": "-", "-": "+", "*": "/", "/": "*", "//": "*", "%": "*", "**": "*", "<<": ">>", ">>": "<<"}
SHEDDING = {  # functions of a number that could pass for their first argument
    "abs", "sqrt", "exp", "log", "floor", "ceil", "round", "rint", "min", "max", "minimum", "maximum", "fmin", "fmax",
    "clip", "clamp", "saturate", "normalize", "sorted", "square", "conjugate",
    "Abs", "Sqrt", "Exp", "Log", "Floor", "Ceil", "Round", "Min", "Max", "Clamp", "Clamp01", "RoundToInt", "FloorToInt",
    "CeilToInt",
}  # fmt: skip
SYMMETRIC = {  # functions that do not care for the order of two arguments
    "min", "max", "minimum", "maximum", "fmin", "fmax", "Min", "Max", "dot", "vdot", "hypot", "isclose", "allclose",
    "logical_and", "logical_or", "gcd", "lcm", "promote_types", "result_type", "samefile", "zip", "Equal", "Equals",
}  # fmt: skip

COMMENT_OR_TEXT = re.compile(r'//[^\n]*|/\*.*?\*/|\$?@?"(?:[^"\\\n]|\\.)*"|\'(?:[^\'\\\n]|\\.)+\'', re.DOTALL)
DIRECTIVE = re.compile(r"^[ \t]*#[^\n]*", re.MULTILINE)
ATTRIBUTE = re.compile(r"^[ \t]*\[[A-Za-z][^\n]*\][ \t]*$", re.MULTILINE)
ROOM = re.compile(r"\b(?:u?int|float|half|bool)\d?(?:x\d)?\s+\w+\[\w+\]")  # of an HLSL array: more of it is as good
SAID = re.compile(r"\bthrow\b[^;]*;|\b(?:Debug\.Log\w*|EditorGUILayout\.\w*|RunLog\.\w+)\([^;]*;")
HLSL_PART = re.compile(r"\bHLSL(?:PROGRAM|INCLUDE)\b(.*?)\bENDHLSL\b", re.DOTALL)
TOKENS = (  # operator, what is found, what takes its place
    ("boundary", re.compile(r"(?<=\s)(<=|>=|==|!=|<|>)(?=\s)"), COMPARED.__getitem__),
    ("sign", re.compile(r"(?<=[\w)\]]\s)(\+|-|\*|/|%|<<|>>)(?=\s)"), SIGNED.__getitem__),
    ("sign", re.compile(r"(?<=\s)(\+=|-=|\*=|/=)(?=\s)"), lambda found: SIGNED[found[:-1]] + "="),
    ("sign", re.compile(r"(?<![\w)\]-])(-)(?=[A-Za-z_(\d])"), lambda found: ""),
    ("sign", re.compile(r"(?<=return )(-)(?=[A-Za-z_(\d])"), lambda found: ""),
    ("logic", re.compile(r"(?<=\s)(&&|\|\||&|\|)(?=\s)"), lambda found: {"&": "|", "|": "&"}[found[0]] * len(found)),
    ("logic", re.compile(r"(?<![\w)\]])(!)(?=[A-Za-z_(])"), lambda found: ""),
    (
        "constant",
        re.compile(r"(?<![\w.])(?<![eE][-+])(\d+)(?=[uUL]?\b)(?!\.\d|[fdm]\b)"),
        lambda found: str(int(found) + 1),
    ),
    ("constant", re.compile(r"(?<![\w.])(\d+\.\d+|\d+(?=[fd]\b))(?=[fd]?\b)"), lambda found: _twice(float(found))),
    ("constant", re.compile(r"\b(true|false)\b"), {"true": "false", "false": "true"}.__getitem__),
)
CALL = re.compile(r"(?<![\w.])((?:\w+(?:\?\.|\.))*(\w+))\(")
WORD_BEFORE_CALL = re.compile(r"[\w>\]?]\s+$")  # a type: what follows is declared, not called
KEYWORDS = {
    "if", "for", "foreach", "while", "switch", "lock", "using", "return", "catch", "sizeof", "nameof", "typeof",
    "default", "register",
}  # fmt: skip


@dataclass(frozen=True)
class Mutant:
    """One fault: what stands from `start` to `end` of a file, replaced."""

    path: str  # from the repository's root
    operator: str
    start: int  # characters
    end: int
    replacement: str
    scope: str = ""  # in Python, the function or method about it that lies in no other

    def apply(self, text: str) -> str:
        return text[: self.start] + self.replacement + text[self.end :]

    def lines(self, text: str) -> tuple[int, str, str]:
        """Number of the first line that changes, the line as it is and as it becomes."""
        mutated = self.apply(text)
        first = text.rfind("\n", 0, self.start) + 1
        number = text.count("\n", 0, first) + 1
        ends = text.find("\n", self.end), mutated.find("\n", self.start + len(self.replacement))
        before, after = (" ".join(t[first:e].split()) for t, e in zip((text, mutated), ends, strict=True))
        return number, before, after


def mutants(path: Path, root: Path) -> list[Mutant]:
    """Every fault that an operator can put into a file, in order; none in what is generated."""
    text = path.read_text(encoding="utf-8")
    if re.match(r"\W*generated\b", text, re.IGNORECASE):
        return []
    name = path.relative_to(root).as_posix()
    if path.suffix == ".py":
        from mutant_python import python_mutants

        return python_mutants(name, text)
    return sorted(text_mutants(name, text), key=lambda mutant: (mutant.start, mutant.end))


def text_mutants(name: str, text: str) -> Iterator[Mutant]:
    """Faults of a C# or HLSL file."""
    code = _code(name, text)
    for operator, pattern, becomes in TOKENS:
        for found in pattern.finditer(code):
            if not (operator == "sign" and _beside_text(text, found.start(1), found.end(1))):
                yield Mutant(name, operator, found.start(1), found.end(1), becomes(found[1]))
    for call in CALL.finditer(code):
        if call[1] not in KEYWORDS:
            yield from _call(name, text, code, call)


def _code(name: str, text: str) -> str:
    """The text, as long as before, with blanks for all that no operator touches."""
    if name.endswith(".shader"):
        kept = [range(*found.span(1)) for found in HLSL_PART.finditer(text)]
        text = "".join(c if c == "\n" or any(i in part for part in kept) else " " for i, c in enumerate(text))
    for pattern in (COMMENT_OR_TEXT, DIRECTIVE, ATTRIBUTE, SAID, *([] if name.endswith(".cs") else [ROOM])):
        text = pattern.sub(lambda found: re.sub(r"[^\n]", " ", found[0]), text)
    return text


def _beside_text(text: str, start: int, end: int) -> bool:
    return text[end:].lstrip()[:1] in ('"', "$") or text[:start].rstrip()[-1:] == '"'


def _call(name: str, text: str, code: str, call: re.Match[str]) -> Iterator[Mutant]:
    parts = arguments(code, call.end() - 1, text)
    end = closing(code, call.end() - 1) + 1
    head = code[: call.start()]
    if head.rstrip()[-1:] in ("{", "}", ";", ")") and head[-1:].isspace() and code[end : end + 1] == ";":
        yield Mutant(name, "dropped call", call.start(), end, "")
    elif WORD_BEFORE_CALL.search(head) and not re.search(r"\b(?:return|else|in|case|new)\s+$", head):
        return  # declared here, not called
    elif call[2] in SHEDDING and parts:
        yield Mutant(name, "dropped call", call.start(), end, f"({text[parts[0].start : parts[0].stop]})")
    if call[2] not in SYMMETRIC:
        yield from _swapped(name, text, code, parts)


def _swapped(name: str, text: str, code: str, parts: list[range]) -> Iterator[Mutant]:
    for a, b in pairwise(parts):
        first, second = text[a.start : a.stop], text[b.start : b.stop]
        declared = any(re.match(r"[\w.<>\[\]]+\??\s+\w", part) for part in (first, second))
        if first != second and not declared and code[a.start : a.stop].strip() and code[b.start : b.stop].strip():
            yield Mutant(name, "swapped argument", a.start, b.stop, second + text[a.stop : b.start] + first)


def arguments(code: str, at: int, text: str) -> list[range]:
    """Where each argument stands, without blanks about it, of the call whose bracket opens at a place."""
    depth, start, found = 0, at + 1, []
    for end in range(at, closing(code, at) + 1):
        depth += (code[end] in "([{") - (code[end] in ")]}")
        if depth == 0 or (depth == 1 and code[end] == ","):
            part = text[start:end]
            found.append(range(start + len(part) - len(part.lstrip()), start + len(part.rstrip())))
            start = end + 1
    return [part for part in found if len(part)]


def _twice(number: float) -> str:
    return repr(number * 2 if number else 1.0)
