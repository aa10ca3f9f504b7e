"""The rules for kernels of ComputeShaders/README.md, as faults found in the text of the shaders.

They keep to what Unity's default compiler and the smallest devices take, whatever the compilers at hand accept.
"""

import math
import re
from collections.abc import Iterator
from itertools import product
from pathlib import Path

from shader_source import COMMENT, Shader, accesses, closing

MOST_BUFFERS = 8  # storage buffers that one stage may bind on every device
MOST_GROUPSHARED = 16 * 1024  # bytes
LEAST_THREADS, MOST_THREADS = 64, 256
ELEMENTS = ("uint", "uint2", "uint4", "float", "float2", "float4")
CONSTANTS = "Constants"

FORBIDDEN = (
    (r"\b(?:Wave[A-Z]\w*|Quad(?:Read|Any|All)\w*)", "a wave or quad intrinsic"),
    (r"\btemplate\b", "a template"),
    (r"\b(?:half[1-4]?(?:x[1-4])?|min1[026]\w+|float16_t\w*|u?int16_t\w*)\b", "a 16-bit type"),
    (r"\b(?:double[1-4]?|u?int64_t\w*)\b", "a 64-bit type"),
    (r"\b(?:enum|using|namespace)\b", "a word that FXC does not know"),
    (r"#\s*pragma\s+use_dxc\b", "use_dxc"),
)
SHADES = re.compile(r"^[ \t]*#define SHADE([2-4]?) half\1[ \t]*$", re.MULTILINE)  # of a fragment, see splat_draw.hlsl
SNAKE_CASE = re.compile(r"[a-z][a-z0-9]*(?:_[a-z0-9]+)*")
CAMEL_CASE = re.compile(r"[a-z][A-Za-z0-9]*")
PASCAL_CASE = re.compile(r"[A-Z][A-Za-z0-9]*")
LOOP = re.compile(r"\s*(?:\[\w+\]\s*)?(?:for|while)\s*\(")
STATEMENT = re.compile(r"[^;{}]*[;{}]?")
BARRIER = re.compile(r"\b(?:Group|Device|All)MemoryBarrier\w*")


def kernel_faults(shader: Shader) -> list[str]:
    """Broken rules in a .compute file, one sentence each."""
    return [*file_faults(shader.path), *_declaration_faults(shader), *_unused(shader), *_entry_faults(shader)]


def file_faults(path: Path) -> list[str]:
    """Words in one file, of any kind, that not every compiler takes.

    A .shader may say that what its fragment computes is of 16 bits; Unity makes these 32 wherever a device lacks them.
    """
    text = COMMENT.sub("", path.read_text())
    if path.suffix == ".shader":
        text = SHADES.sub("", text)
    return [f"{path.name}: {found[0]} is {what}" for pattern, what in FORBIDDEN if (found := re.search(pattern, text))]


def package_faults(kernels: list[Shader], draws: list[tuple[Shader, list[str]]], root: Path) -> list[str]:
    """Broken rules between files: a name of two types, a function that nothing calls, no reference, no test.

    `draws` are the shaders that draw, with their entry points.
    """
    faults = []
    elements: dict[str, tuple[str, str]] = {}
    for shader in kernels:
        for buffer in shader.buffers.values():
            element, first = elements.setdefault(buffer.name, (buffer.element, shader.path.name))
            if element != buffer.element:
                faults.append(f"{shader.path.name}: {buffer.name} is {buffer.element}, but {element} in {first}")
        faults += _companions(shader, root)
    entries = [(shader, shader.kernels) for shader in kernels] + draws
    declared = {name for shader, _ in entries for name in shader.functions}
    called = {function.name for shader, names in entries for entry in names for function in shader.reached(entry)}
    return faults + [f"{name}: a function that nothing calls" for name in sorted(declared - called)]


def _companions(shader: Shader, root: Path) -> Iterator[str]:
    """One stem for each kernel: its reference, and its test, which with what it imports names every entry point."""
    stem = shader.path.stem
    if not (root / "python" / "mua" / "kernels" / f"{stem}.py").is_file():
        yield f"{shader.path.name}: there is no reference python/mua/kernels/{stem}.py"
    test = root / "tests" / "parity" / f"test_{stem}.py"
    text = test.read_text() if test.is_file() else ""
    text += "".join(path.read_text() for path in test.parent.glob("*.py") if f"from {path.stem} import" in text)
    for entry in shader.kernels:
        if f'"{entry}"' not in text:
            yield f"{shader.path.name}: tests/parity/test_{stem}.py does not run {entry}"


def _declaration_faults(shader: Shader) -> Iterator[str]:
    name = shader.path.name
    for other in shader.others:
        yield f"{name}: {other} is no structured buffer"
    for buffer in shader.buffers.values():
        if buffer.element not in ELEMENTS:
            yield f"{name}: {buffer.name} has elements {buffer.element}, expected one of {', '.join(ELEMENTS)}"
    for block in shader.blocks:
        if block != CONSTANTS:
            yield f"{name}: cbuffer {block}, expected one cbuffer {CONSTANTS}"
    for bound in [*shader.buffers, *(member for members in shader.blocks.values() for member in members)]:
        if not SNAKE_CASE.fullmatch(bound):
            yield f"{name}: {bound} is bound from outside, expected snake_case"
    for function in shader.functions:
        style = PASCAL_CASE if function in shader.kernels else CAMEL_CASE
        if not style.fullmatch(function):
            yield f"{name}: {function}, expected {'PascalCase' if style is PASCAL_CASE else 'camelCase'}"


def _unused(shader: Shader) -> Iterator[str]:
    """Declarations of the file itself that none of its kernels reaches."""
    words = {word for entry in shader.kernels for function in shader.reached(entry) for word in function.words}
    members = [member for block in shader.blocks.values() for member in block]
    for name in [*shader.buffers, *members, *shader.groupshared]:
        if name not in words:
            yield f"{shader.path.name}: no kernel uses {name}"


def _entry_faults(shader: Shader) -> Iterator[str]:
    for name, function in shader.functions.items():
        if "numthreads" in function.head and name not in shader.kernels:
            yield f"{shader.path.name}: {name} has numthreads but no #pragma kernel"
    for entry in shader.kernels:
        where = f"{shader.path.name}: {entry}"
        if entry not in shader.functions:
            yield f"{where} is not defined"
            continue
        buffers = [buffer.name for buffer in shader.used(entry)]
        if len(buffers) > MOST_BUFFERS:
            yield f"{where} binds {len(buffers)} buffers, expected at most {MOST_BUFFERS}: {', '.join(buffers)}"
        shared = shader.groupshared_bytes(entry)
        if shared > MOST_GROUPSHARED:
            yield f"{where} has {shared} bytes groupshared, expected at most {MOST_GROUPSHARED}"
        threads = math.prod(shader.threads(entry))
        if not LEAST_THREADS <= threads <= MOST_THREADS:
            yield f"{where} has {threads} threads in a group, expected {LEAST_THREADS} to {MOST_THREADS}"
        yield from _barrier_faults(shader, entry)
        yield from _race_faults(shader, entry)


def _barrier_faults(shader: Shader, entry: str) -> Iterator[str]:
    """A `return` ahead of a barrier, or of a call that holds one, and a barrier in a branch, in all that is reached."""
    reached = shader.reached(entry)
    waiting = {function.name for function in reached if _waits(shader, function.name)}
    for function in reached:
        where = f"{shader.path.name}: {entry}: {function.name}"
        body = function.body
        barriers = [found.start() for found in re.finditer(r"\w+", body) if found[0] in waiting]
        barriers += [found.start() for found in BARRIER.finditer(body)]
        if re.search(r"\breturn\b", body[: max(barriers, default=0)]):
            yield f"{where} returns before a barrier"
        if any(start < at < end for start, end in _branches(body) for at in barriers):
            yield f"{where} has a barrier in a branch"


def _race_faults(shader: Shader, entry: str) -> Iterator[str]:
    """Elements of groupshared memory that one statement writes and another reads, with no barrier between the two.

    An index that is spelled alike is taken for the thread's own element, and one statement for safe in itself.
    """
    since: list[tuple[str, str, str, str]] = []  # after the last barrier: statement, array, r or w, index
    faults = set[str]()
    for statement in _steps(shader, shader.functions[entry].body):
        if BARRIER.search(statement):
            since = []
        found = [(statement, name, *access) for name in shader.groupshared for access in accesses(statement, name)]
        faults |= {former[1] for former, latter in product(since, found) if _races(former, latter)}
        since += found
    for name in sorted(faults):
        yield f"{shader.path.name}: {entry}: no barrier between two uses of {name}"


def _races(former: tuple[str, str, str, str], latter: tuple[str, str, str, str]) -> bool:
    (first, name, before, place), (second, other, after, index) = former, latter
    if name != other or (place == index != "") or ("Interlocked" in first and "Interlocked" in second):
        return False
    return ("w" in before and "r" in after) or ("r" in before and "w" in after)


def _steps(shader: Shader, body: str) -> Iterator[str]:
    """Statements in the order in which a thread meets them; what is repeated or called comes twice."""
    at = 0
    while at < len(body):
        if loop := LOOP.match(body, at):
            start = closing(body, loop.end() - 1) + 1
            at = _statement_end(body, start)
            yield from 2 * list(_steps(shader, body[start:at]))
        else:
            matched = STATEMENT.match(body, at)
            assert matched, body[at:]  # it matches whatever stands there
            statement = matched[0]
            for word in re.findall(r"\w+", statement):
                if word in shader.functions:
                    yield from 2 * list(_steps(shader, shader.functions[word].body))
            yield statement
            at += len(statement)


def _statement_end(body: str, start: int) -> int:
    block = re.match(r"\s*\{", body[start:])
    return (closing(body, start + block.end() - 1) if block else body.index(";", start)) + 1


def _branches(body: str) -> Iterator[tuple[int, int]]:
    """Where the statements under each `if` and `else` begin and end."""
    for found in re.finditer(r"\b(?:if|else)\b(?!\s+if\b)", body):
        start = found.end() if found[0] == "else" else closing(body, body.index("(", found.end())) + 1
        yield start, _statement_end(body, start) - 1


def _waits(shader: Shader, name: str) -> bool:
    return any(BARRIER.search(function.body) for function in shader.reached(name))
