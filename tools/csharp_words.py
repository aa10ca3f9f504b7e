"""C# source as words: without comments, strings emptied, and of conditions (`#if`) the branches that are compiled."""

import re
from collections.abc import Callable, Collection, Iterator

WORDS = re.compile(r'"[^"]*"|[A-Za-z_@]\w*|\d[\w.]*|=>|::|==|!=|\?\?=?|\S')
TEXT = re.compile(r'//[^\n]*|/\*.*?\*/|\$?@\$?"(?:[^"]|"")*"|\$?"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'', re.DOTALL)
CONDITION = re.compile(r"[A-Za-z_]\w*|&&|\|\||==|!=|\S")
BRACKETS = {"(": ")", "[": "]", "{": "}"}
PASSED = ("this", "ref", "out", "in", "params", "scoped", "readonly")  # before a parameter's type
SYSTEM = {
    "Boolean": "bool", "Byte": "byte", "Int16": "short", "UInt16": "ushort", "Int32": "int", "UInt32": "uint",
    "Int64": "long", "UInt64": "ulong", "Single": "float", "Double": "double", "String": "string",
}  # fmt: skip


def words(text: str, symbols: Collection[str]) -> list[str]:
    """The words of a file as it is compiled with `symbols`."""
    bare = TEXT.sub(lambda match: " " if match[0].startswith("/") else '""', text)
    return WORDS.findall("\n".join(_compiled(bare, symbols)))


def _compiled(text: str, symbols: Collection[str]) -> Iterator[str]:
    branches: list[tuple[bool, bool]] = []  # of each open #if: whether this branch is read, whether one was
    for line in text.splitlines():
        directive = line.strip()
        if not directive.startswith("#"):
            if all(is_read for is_read, _ in branches):
                yield line
            continue
        word, rest = re.match(r"#\s*(\w*)(.*)", directive).groups()  # type: ignore[union-attr] of any text
        if word == "if":
            holds = condition(rest, symbols)
            branches.append((holds, holds))
        elif word == "elif":
            holds = not branches[-1][1] and condition(rest, symbols)
            branches[-1] = (holds, holds or branches[-1][1])
        elif word == "else":
            branches[-1] = (not branches[-1][1], True)
        elif word == "endif":
            branches.pop()


def condition(text: str, symbols: Collection[str]) -> bool:
    """Whether a condition of the preprocessor holds."""
    return _Condition(CONDITION.findall(text), symbols).holds()


class _Condition:
    """Ors of ands of symbols, by a place in their words."""

    def __init__(self, found: list[str], symbols: Collection[str]) -> None:
        self._words, self._symbols = [*found, ""], symbols

    def holds(self) -> bool:
        return self._joined("||", lambda: self._joined("&&", self._equal))

    def _joined(self, sign: str, part: Callable[[], bool]) -> bool:
        """Parts between signs; all are read, whatever the first says."""
        held = [part()]
        while self._words[0] == sign:
            del self._words[0]
            held.append(part())
        return any(held) if sign == "||" else all(held)

    def _equal(self) -> bool:
        held = self._one()
        while self._words[0] in ("==", "!="):
            held = (self._words.pop(0) == "==") == (held == self._one())
        return held

    def _one(self) -> bool:
        word = self._words.pop(0)
        if word == "!":
            return not self._one()
        if word == "(":
            held = self.holds()
            del self._words[0]
            return held
        return word == "true" or word in self._symbols


def split(found: list[str], sign: str) -> list[list[str]]:
    """Parts between signs that stand outside of brackets; none of nothing."""
    parts: list[list[str]] = [[]]
    depth = 0
    for word in found:
        depth += (word in "([{<") - (word in ")]}>")
        if word == sign and depth == 0:
            parts.append([])
        else:
            parts[-1].append(word)
    return parts if parts != [[]] else []


def opening(found: list[str]) -> int:
    """Where the angle bracket begins that the last word ends."""
    depth = 0
    for at in range(len(found) - 1, -1, -1):
        depth += (found[at] == ">") - (found[at] == "<")
        if depth == 0:
            return at
    return 0


def closing(found: list[str]) -> int:
    """Where the square bracket ends that the first word begins."""
    depth = 0
    for at, word in enumerate(found):
        depth += (word == "[") - (word == "]")
        if depth == 0:
            return at
    return len(found)


def parameter(found: list[str], names: dict[str, str]) -> str:
    """A parameter without its name and attributes: `out float`, with ` =` after what a call may leave out."""
    while found and found[0] == "[":
        found = found[closing(found) + 1 :]
    optional = " =" if "=" in found else ""
    found = found[: found.index("=")] if "=" in found else found
    passed = next((f"{word} " for word in found if word in ("ref", "out", "in")), "")
    return passed + spell([word for word in found if word not in PASSED][:-1], names) + optional


def spell(found: list[str], names: dict[str, str]) -> str:
    """A type's words as one, without namespaces; `names` says what stands for some."""
    kept: list[str] = []
    for word in found:
        if word in ("ref", "readonly"):
            continue
        if kept and kept[-1] in (".", "::"):
            kept[-2:] = [word]
        else:
            kept.append(word)
    text = "".join(names.get(word, SYSTEM.get(word, word)) for word in kept)
    return re.sub(r"([\w.<>!,\[\]]+)\?", r"Nullable<\1>", text)
