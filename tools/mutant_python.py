"""The faults of mutant_sites.py in Python, found in the syntax tree and put into the text, which keeps its form."""

import ast
import re
from itertools import pairwise

from mutant_sites import COMPARED, SHEDDING, SIGNED, SYMMETRIC, Mutant

WORDS = {"is": "is not", "is not": "is", "in": "not in", "not in": "in"}
COMPARISON = re.compile(r"<=|>=|==|!=|<|>|\bis\s+not\b|\bis\b|\bnot\s+in\b|\bin\b")
ARITHMETIC = re.compile(r"\*\*|//|<<|>>|[-+*/%@]")
SAID = {
    "print", "echo", "warn", "add_note", "log", "info", "debug", "warning", "note", "InputError", "Option", "Argument",
    "Typer", "Table",
}  # fmt: skip
NEITHER_WAY = {"strict", "frozen", "slots", "exist_ok", "parents"}  # what only an unsound program would meet
GUARD = 1e-6  # numbers as small, or as large the other way, only keep from dividing by zero


def python_mutants(name: str, text: str) -> list[Mutant]:
    finder = _Finder(name, text)
    finder.visit(ast.parse(text))
    return sorted(finder.found, key=lambda mutant: (mutant.start, mutant.end))


class _Finder(ast.NodeVisitor):
    def __init__(self, name: str, text: str) -> None:
        self._name, self._text, self.found = name, text, list[Mutant]()
        self._scope: list[str] = []
        self._in_function = False
        lines = text.splitlines(keepends=True)
        self._starts = [0]
        for line in lines:
            self._starts.append(self._starts[-1] + len(line))
        self._lines = [line.encode() for line in lines]

    def _at(self, line: int, column: int) -> int:
        return self._starts[line - 1] + len(self._lines[line - 1][:column].decode())

    def _span(self, node: ast.AST) -> tuple[int, int]:
        n = node  # every node that is asked for has a place
        return self._at(n.lineno, n.col_offset), self._at(n.end_lineno, n.end_col_offset)  # type: ignore[attr-defined]

    def _source(self, node: ast.AST) -> str:
        start, end = self._span(node)
        return self._text[start:end]

    def _add(self, operator: str, start: int, end: int, replacement: str) -> None:
        scope = ".".join(self._scope) if self._in_function else ""
        self.found.append(Mutant(self._name, operator, start, end, replacement, scope))

    def _between(
        self, operator: str, left: ast.AST, right: ast.AST, pattern: re.Pattern[str], to: dict[str, str]
    ) -> None:
        """Replace the operator that stands between two nodes."""
        start, end = self._span(left)[1], self._span(right)[0]
        code = re.sub(r"#[^\n]*", lambda found: " " * len(found[0]), self._text[start:end])
        if (found := pattern.search(code)) and (word := " ".join(found[0].split())) in to:
            self._add(operator, start + found.start(), start + found.end(), to[word])

    # what no behaviour hangs on

    def visit_Raise(self, node: ast.Raise) -> None:
        pass

    def visit_Assert(self, node: ast.Assert) -> None:
        pass

    def visit_JoinedStr(self, node: ast.JoinedStr) -> None:
        pass

    def visit_AnnAssign(self, node: ast.AnnAssign) -> None:
        if node.value is not None:
            self.visit(node.value)

    def visit_If(self, node: ast.If) -> None:
        guard = ast.unparse(node.test)
        if guard not in ("TYPE_CHECKING", "__name__ == '__main__'"):
            self.generic_visit(node)

    def visit_ClassDef(self, node: ast.ClassDef) -> None:
        self._inside(node.name, node.body, function=False)

    def visit_FunctionDef(self, node: ast.FunctionDef) -> None:
        for default in (*node.args.defaults, *filter(None, node.args.kw_defaults)):
            self.visit(default)
        self._inside(node.name, node.body, function=True)

    def _inside(self, name: str, body: list[ast.stmt], *, function: bool) -> None:
        outer = self._in_function
        if not outer:
            self._scope.append(name)
        self._in_function = outer or function
        for statement in body:
            self.visit(statement)
        self._in_function = outer
        if not outer:
            self._scope.pop()

    # operators

    def visit_Compare(self, node: ast.Compare) -> None:
        for left, right in pairwise([node.left, *node.comparators]):
            self._between("boundary", left, right, COMPARISON, COMPARED | WORDS)
        self.generic_visit(node)

    def visit_BinOp(self, node: ast.BinOp) -> None:
        is_text = any(isinstance(n, ast.JoinedStr) or _is_text(n) for n in (node.left, node.right))
        if isinstance(node.op, ast.MatMult) and self._source(node.left) != self._source(node.right):
            (start, middle), (second, end) = self._span(node.left), self._span(node.right)
            if ")" not in self._text[middle:second] and "(" not in self._text[middle:second]:
                swapped = self._text[second:end] + self._text[middle:second] + self._text[start:middle]
                self._add("swapped argument", start, end, swapped)
        elif not is_text:
            self._between("sign", node.left, node.right, ARITHMETIC, SIGNED)
        self.generic_visit(node)

    def visit_AugAssign(self, node: ast.AugAssign) -> None:
        self._between("sign", node.target, node.value, ARITHMETIC, SIGNED)
        self.generic_visit(node)

    def visit_BoolOp(self, node: ast.BoolOp) -> None:
        for left, right in pairwise(node.values):
            self._between("logic", left, right, re.compile(r"\b(?:and|or)\b"), {"and": "or", "or": "and"})
        self.generic_visit(node)

    def visit_UnaryOp(self, node: ast.UnaryOp) -> None:
        if isinstance(node.op, ast.USub | ast.Not | ast.Invert):
            operator, word = ("logic", "not ") if isinstance(node.op, ast.Not) else ("sign", "-")
            start = self._span(node)[0]
            self._add(operator, start, start + len(word), "")
        self.generic_visit(node)

    def visit_Constant(self, node: ast.Constant) -> None:
        value, (start, end) = node.value, self._span(node)
        if isinstance(value, bool):
            self._add("constant", start, end, str(not value))
        elif isinstance(value, int):
            self._add("constant", start, end, str(value + 1))
        elif isinstance(value, float) and (value == 0 or GUARD < abs(value) < 1 / GUARD):
            self._add("constant", start, end, repr(value * 2 if value else 1.0))

    def visit_Expr(self, node: ast.Expr) -> None:
        if isinstance(node.value, ast.Call) and _name(node.value) not in SAID:
            self._add("dropped call", *self._span(node), "pass")
        self.generic_visit(node)

    def visit_keyword(self, node: ast.keyword) -> None:
        if node.arg not in NEITHER_WAY:
            self.visit(node.value)

    def visit_Call(self, node: ast.Call) -> None:
        name = _name(node)
        if name in SAID:
            return
        if name in SHEDDING and node.args and not isinstance(node.args[0], ast.Starred | ast.GeneratorExp):
            self._add("dropped call", *self._span(node), f"({self._source(node.args[0])})")
        for a, b in pairwise(node.args):
            first, second = self._source(a), self._source(b)
            if (
                name not in SYMMETRIC
                and first != second
                and not isinstance(a, ast.Starred)
                and not isinstance(b, ast.Starred)
            ):
                (start, middle), (then, end) = self._span(a), self._span(b)
                self._add("swapped argument", start, end, second + self._text[middle:then] + first)
        self.generic_visit(node)


def _is_text(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and isinstance(node.value, str)


def _name(call: ast.Call) -> str:
    function = call.func
    return function.attr if isinstance(function, ast.Attribute) else getattr(function, "id", "")
