"""Reads what a shader declares and what each of its entry points reaches, from its text."""

import ast
import operator
import re
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"')
DEFINE = re.compile(r"^\s*#\s*define\s+(\w+)[ \t]+(\S.*)$")
KERNEL = re.compile(r"^\s*#\s*pragma\s+kernel\s+(\w+)", re.MULTILINE)
NUMTHREADS = re.compile(r"\[numthreads\(([^)]*)\)\]")
BUFFER = re.compile(r"^((?:RW)?StructuredBuffer)\s*<\s*(\w+)\s*>\s*(\w+)$")
RESOURCE = re.compile(r"^(?:RW|Append|Consume)?(?:Structured|ByteAddress)?(?:Buffer|Texture)\w*\b")
GROUPSHARED = re.compile(r"^groupshared\s+(\w+)\s+(\w+)((?:\s*\[[^\]]*\])*)$")
CONSTANT = re.compile(r"^static\s+const\s+\w+\s+(\w+)\s*=\s*(.*)$", re.DOTALL)
FUNCTION = re.compile(r"^(?:\[[^\]]*\]\s*)*\w+\s+(\w+)\s*\(")
WORD = re.compile(r"(?<![.\w])[A-Za-z_]\w*")  # no member of a struct or vector
SCALAR_BYTES = 4
OPERATORS = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.floordiv,
    ast.LShift: operator.lshift,
}


@dataclass(frozen=True)
class Buffer:
    name: str
    element: str
    writable: bool


@dataclass(frozen=True)
class Function:
    name: str
    head: str  # attributes, type, name, parameters
    body: str

    @cached_property
    def words(self) -> frozenset[str]:
        return frozenset(WORD.findall(self.body))


@dataclass
class Shader:
    """The declarations of a file and of what it includes."""

    path: Path
    text: str  # with includes, without comments and directives
    kernels: list[str] = field(default_factory=list)
    buffers: dict[str, Buffer] = field(default_factory=dict)
    blocks: dict[str, list[str]] = field(default_factory=dict)  # members of each cbuffer
    groupshared: dict[str, str] = field(default_factory=dict)  # element type and lengths
    constants: dict[str, str] = field(default_factory=dict)
    functions: dict[str, Function] = field(default_factory=dict)
    others: list[str] = field(default_factory=list)  # resources that are no structured buffer

    def reached(self, entry: str) -> list[Function]:
        """The functions that an entry point calls at any depth, itself first."""
        found, waiting = [], [entry]
        while waiting:
            function = self.functions.get(waiting.pop())
            if function is not None and function not in found:
                found.append(function)
                waiting += sorted(function.words & self.functions.keys())
        return found

    def used(self, entry: str) -> list[Buffer]:
        """The buffers that an entry point reaches, in order of declaration."""
        words = {word for function in self.reached(entry) for word in function.words}
        return [buffer for buffer in self.buffers.values() if buffer.name in words]

    def accesses(self, entry: str, buffer: str) -> tuple[bool, bool]:
        """Whether an entry point reads elements of a buffer, and whether it writes them."""
        kinds = [kind for function in self.reached(entry) for kind, _ in accesses(function.body, buffer)]
        return any("r" in kind for kind in kinds), any("w" in kind for kind in kinds)

    def threads(self, entry: str) -> tuple[int, ...]:
        """Threads of a group along each axis; empty if the entry point has none."""
        found = NUMTHREADS.search(self.functions[entry].head) if entry in self.functions else None
        return tuple(self.value(part) for part in found[1].split(",")) if found else ()

    def groupshared_bytes(self, entry: str) -> int:
        """Bytes of the groupshared arrays that an entry point reaches."""
        words = {word for function in self.reached(entry) for word in function.words}
        return sum(self._bytes(of) for name, of in self.groupshared.items() if name in words)

    def value(self, expression: str) -> int:
        """A constant expression; KeyError or SyntaxError where it is none."""
        return self._value(ast.parse(expression.strip().rstrip("u"), mode="eval").body)

    def _value(self, node: ast.expr) -> int:
        if isinstance(node, ast.BinOp):
            return int(OPERATORS[type(node.op)](self._value(node.left), self._value(node.right)))
        if isinstance(node, ast.Name):
            return self.value(self.constants[node.id])
        return int(ast.literal_eval(node))

    def _bytes(self, declared: str) -> int:
        element, *lengths = declared.split("[")
        element = self.constants.get(element, element)
        count = SCALAR_BYTES * int(element[-1] if element[-1].isdigit() else 1)
        for length in lengths:
            count *= self.value(length.rstrip("] "))
        return count


def read(path: Path, directory: Path) -> Shader:
    """Read a shader whose includes lie beside it or in `directory`."""
    constants: dict[str, str] = {}
    text = _inlined(path, directory, set(), constants)
    shader = Shader(path, text, KERNEL.findall(COMMENT.sub("", path.read_text())), constants=constants)
    for statement in _statements(text):
        _declare(shader, statement)
    return shader


def _inlined(path: Path, directory: Path, seen: set[Path], constants: dict[str, str]) -> str:
    """The text with every include in its place, once; `#define NAME VALUE` goes to `constants`, the first one holds."""
    seen.add(path)
    lines = []
    for line in COMMENT.sub("", path.read_text()).splitlines():
        if found := INCLUDE.match(line):
            beside = path.parent / found[1]
            included = beside if beside.is_file() else directory / found[1]
            lines += [] if included in seen else [_inlined(included, directory, seen, constants)]
        elif found := DEFINE.match(line):
            constants.setdefault(found[1], found[2])
        elif not line.lstrip().startswith("#"):
            lines.append(line)
    return "\n".join(lines)


def _statements(text: str) -> list[str]:
    """The declarations of a text, each without its closing semicolon."""
    found, depth, start = [], 0, 0
    for at, letter in enumerate(text):
        depth += (letter in "{(") - (letter in "})")
        if depth == 0 and (letter == ";" or (letter == "}" and "=" not in text[start:at].split("{")[0])):
            found.append(text[start : at + (letter == "}")].strip())
            start = at + 1
    return [statement for statement in found if statement]


def _declare(shader: Shader, statement: str) -> None:
    if found := BUFFER.match(statement):
        shader.buffers[found[3]] = Buffer(found[3], found[2], found[1].startswith("RW"))
    elif RESOURCE.match(statement):
        shader.others.append(statement)
    elif found := GROUPSHARED.match(statement):
        shader.groupshared[found[2]] = found[1] + found[3]
    elif found := CONSTANT.match(statement):
        shader.constants[found[1]] = found[2]
    elif statement.startswith("cbuffer"):
        name, _, members = statement.partition("{")
        declared = [member.strip() for member in members.rstrip("}").split(";")]
        shader.blocks[name.split()[1]] = [WORD.findall(member.split("[")[0])[-1] for member in declared if member]
    elif (found := FUNCTION.match(statement)) and statement.endswith("}"):
        head, _, body = statement.partition("{")
        known = shader.functions.get(found[1])  # overloads count as one
        shader.functions[found[1]] = Function(found[1], head, body if known is None else known.body + body)


def accesses(body: str, buffer: str) -> list[tuple[str, str]]:
    """r, w or rw for each element of a buffer that a function body names, and its index."""
    found = []
    for place in re.finditer(rf"(?<![.\w]){buffer}\b", body):
        before, (index, after) = body[: place.start()], _index(body, place.end())
        if re.search(r"Interlocked\w+\(\s*$", before) or re.match(r"\s*(?:[-+*/&|^]|<<|>>)=|\s*(?:\+\+|--)", after):
            found.append(("rw", index))
        else:
            found.append(("w" if re.match(r"\s*(?:\.\w+)?\s*=(?!=)", after) else "r", index))
    return found


def closing(text: str, at: int) -> int:
    """The place where the bracket that opens at a place of a text is closed."""
    depth = 0
    for end in range(at, len(text)):
        depth += (text[end] in "([{") - (text[end] in ")]}")
        if depth == 0:
            return end
    return len(text)


def _index(body: str, at: int) -> tuple[str, str]:
    """The content of the `[...]` at a place of a text, and the text after it."""
    blank = len(body[at:]) - len(body[at:].lstrip())
    if body[at + blank : at + blank + 1] != "[":
        return "", body[at:]
    end = closing(body, at + blank)
    return body[at + blank + 1 : end], body[end + 1 :]
