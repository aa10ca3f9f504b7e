"""Types and their members as C# sources declare them: by the text, without a compiler.

Bodies are passed over. Types of values are kept without their namespaces, type parameters as `!0` of a type and `!!0`
of a method, so that a declaration can be set against one from an assembly.
"""

import re
from collections.abc import Collection
from dataclasses import dataclass, field, replace
from pathlib import Path

from csharp_words import BRACKETS, opening, parameter, spell, split, words

MODIFIERS = {
    "public", "protected", "internal", "private", "static", "extern", "abstract", "virtual", "override", "sealed",
    "readonly", "const", "new", "unsafe", "partial", "volatile", "async", "ref", "required", "fixed",
}  # fmt: skip
KINDS = ("class", "struct", "interface", "enum", "record")
OPERATORS = {
    "+": "op_Addition", "-": "op_Subtraction", "*": "op_Multiply", "/": "op_Division", "==": "op_Equality",
    "!=": "op_Inequality", "implicit": "op_Implicit", "explicit": "op_Explicit",
}  # fmt: skip
UNARY = {"+": "op_UnaryPlus", "-": "op_UnaryNegation"}
ENDS = ("{", ";", "=>", "=", "(")  # of what stands before a member's body, value or parameters


@dataclass(frozen=True)
class Member:
    """A declaration in a type."""

    kinds: frozenset[str] = (
        frozenset()
    )  # how it is used: constructor, method, get, set, field, add, remove, enum, const
    name: str = ""
    value: str = ""  # type of what it holds or returns
    parameters: tuple[str, ...] = ()  # as csharp_words.parameter has them
    is_static: bool = False
    is_open: bool = True  # public, or protected
    closed: frozenset[str] = frozenset()  # accessors that are neither
    obsolete: str = ""  # "", "warning" or "error"
    failing: frozenset[str] = frozenset()  # accessors that are an error to use
    number: str = ""  # of an enum member or a constant, as it is written


@dataclass
class Declared:
    """A type, with the parts of all its files."""

    name: str  # with its namespace and the types about it, parted by dots; `n for n type parameters
    kind: str
    bases: list[str] = field(default_factory=list)
    members: list[Member] = field(default_factory=list)
    obsolete: str = ""
    is_open: bool = False


def read(folders: Collection[Path], symbols: Collection[str]) -> dict[str, Declared]:
    """The types below folders, by name."""
    found: dict[str, Declared] = {}
    for folder in folders:
        for path in sorted(folder.rglob("*.cs")):
            _File(words(path.read_text(encoding="utf-8-sig", errors="replace"), symbols), found).read()
    return found


class _File:
    """The words of one file, and a place among them."""

    def __init__(self, found: list[str], types: dict[str, Declared]) -> None:
        self._words, self._types, self._at = found, types, 0
        self._names: dict[str, str] = {}  # what stands for a name: of `using`, and of the type's own parameters

    def read(self) -> None:
        self._space("")

    def _peek(self, ahead: int = 0) -> str:
        at = self._at + ahead
        return self._words[at] if at < len(self._words) else ""

    def _take(self) -> str:
        self._at += 1
        return self._peek(-1)

    def _until(self, *ends: str) -> list[str]:
        """Words up to one of `ends` that stands outside of brackets; it is left."""
        taken: list[str] = []
        while (word := self._peek()) and word not in ends:
            taken += self._balanced() if word in BRACKETS else [self._take()]
        return taken

    def _balanced(self) -> list[str]:
        end = BRACKETS[self._peek()]
        taken = [self._take()]
        while (word := self._peek()) and word != end:
            taken += self._balanced() if word in BRACKETS else [self._take()]
        return [*taken, self._take()]

    def _body(self) -> None:
        """Passes over what a member is made of."""
        if self._peek() == "{":
            self._balanced()
        else:
            self._until(";")
            self._take()

    def _space(self, prefix: str) -> None:
        """What stands in a file or in a namespace, to its end."""
        while (word := self._peek()) not in ("", "}"):
            if word == "namespace":
                self._take()
                inner = "".join(self._until("{", ";"))
                if self._take() == "{":
                    self._space(f"{prefix}{inner}.")
                    self._take()
                else:
                    prefix = f"{prefix}{inner}."
            elif word in ("using", "extern"):
                self._using(self._until(";"))
                self._take()
            elif word == "[" and self._peek(1) in ("assembly", "module"):
                self._balanced()
            else:
                self._declaration(prefix, None)

    def _using(self, found: list[str]) -> None:
        if "=" in found:
            at = found.index("=")
            self._names[found[at - 1]] = spell(found[at + 1 :], {})

    def _attributes(self) -> str:
        """Whether what follows is obsolete."""
        obsolete = ""
        while self._peek() == "[":
            text = "".join(self._balanced())
            if match := re.search(r"\bObsolete(?:Attribute)?\b(\(.*)?", text):
                obsolete = "error" if re.search(r",(?:error:)?true\)", match[1] or "") else "warning"
        return obsolete

    def _modifiers(self) -> set[str]:
        found: set[str] = set()
        while self._peek() in MODIFIERS:
            found.add(self._take())
        return found

    def _declaration(self, prefix: str, owner: Declared | None) -> None:
        obsolete, modifiers = self._attributes(), self._modifiers()
        is_open = bool(modifiers & {"public", "protected"}) or (owner is not None and owner.kind == "interface")
        marks = Member(obsolete=obsolete, is_open=is_open, is_static=bool(modifiers & {"static", "const"}))
        if self._peek() in KINDS and self._peek(1) not in ("(", "="):
            self._type(prefix, marks)
        elif self._peek() == "delegate":
            self._delegate(prefix, marks)
        elif owner is None or self._peek() == ";":
            self._take()  # nothing that this reader knows
        elif self._peek() == "~":
            self._until("{", "=>")
            self._body()
        else:
            owner.members += self._members(owner, marks, is_const="const" in modifiers)

    def _declared(self, name: str, kind: str, marks: Member) -> Declared:
        made = self._types.setdefault(name, Declared(name, kind))
        made.obsolete, made.is_open = made.obsolete or marks.obsolete, made.is_open or marks.is_open
        return made

    def _type(self, prefix: str, marks: Member) -> None:
        kind = self._take()
        header = self._until("{", ";", ":")
        bases = self._until("{", ";")[1:]
        header = header[: header.index("where")] if "where" in header else header
        bases = bases[: bases.index("where")] if "where" in bases else bases
        given = [part[-1] for part in split(header[opening(header) + 1 : -1], ",")] if header[-1] == ">" else []
        name = header[opening(header) - 1] if given else header[-1]
        made = self._declared(prefix + name + (f"`{len(given)}" if given else ""), kind, marks)
        outer, self._names = self._names, self._names | {each: f"!{i}" for i, each in enumerate(given)}
        made.bases += [spell(part, self._names) for part in split(bases, ",")] if kind != "enum" else []
        if self._take() == "{":
            while self._peek() not in ("", "}"):
                self._enum_member(made) if kind == "enum" else self._declaration(f"{made.name}.", made)
            self._take()
        self._names = outer

    def _enum_member(self, made: Declared) -> None:
        obsolete, name = self._attributes(), self._take()
        number = "".join(self._until(",", "}")).lstrip("=")
        if self._peek() == ",":
            self._take()
        last = made.members[-1].number if made.members else ""
        number = number or (f"{last}+1" if last else "0")
        made.members.append(
            Member(frozenset({"enum"}), name, made.name, is_static=True, obsolete=obsolete, number=number)
        )

    def _delegate(self, prefix: str, marks: Member) -> None:
        header = self._until("(")
        self._body()
        arity = 0
        if header[-1] == ">":
            arity = len(split(header[opening(header) + 1 : -1], ","))
            header = header[: opening(header)]
        self._declared(prefix + header[-1] + (f"`{arity}" if arity else ""), "delegate", marks)

    def _members(self, owner: Declared, marks: Member, *, is_const: bool) -> list[Member]:
        is_event = self._peek() == "event"
        if is_event:
            self._take()
        header = self._until(*ENDS)
        while self._peek() == "(" and not header:  # a tuple is the type
            header = [*self._balanced(), *self._until(*ENDS)]
        if not header:
            self._body()  # nothing that this reader knows
            return []
        if self._peek() == "(":
            return self._method(owner, header, marks)
        found = self._values(header, marks)
        if is_event:
            return [replace(each, kinds=frozenset({"add", "remove"}), closed=frozenset()) for each in found]
        return [replace(each, kinds=frozenset({"const"})) for each in found] if is_const else found

    def _method(self, owner: Declared, header: list[str], marks: Member) -> list[Member]:
        """A method, an operator or a constructor; none for what implements an interface by its name."""
        given = split(self._balanced()[1:-1], ",")
        self._until("{", ";", "=>")
        self._body()
        names, kind, name, value = self._names, "method", "", header[:-1]
        if header == [owner.name.split(".")[-1].split("`")[0]]:
            kind = "constructor"
        elif "operator" in header:
            at = header.index("operator")
            converts = header[at - 1] in ("implicit", "explicit")
            word = header[at - 1] if converts else "".join(header[at + 1 :])
            name = UNARY[word] if len(given) == 1 and word in UNARY else OPERATORS.get(word, word)
            value = header[at + 1 :] if converts else header[:at]
        else:
            if header[-1] == ">":
                start = opening(header)
                parts = split(header[start + 1 : -1], ",")
                names = names | {part[-1]: f"!!{i}" for i, part in enumerate(parts)}
                header = header[:start]
            name, value = header[-1], header[:-1]
            if not value or value[-1] == ".":
                return []
        parameters = tuple(parameter(part, names) for part in given)
        return [replace(marks, kinds=frozenset({kind}), name=name, value=spell(value, names), parameters=parameters)]

    def _values(self, header: list[str], marks: Member) -> list[Member]:
        """A property, an indexer, an event, or fields; none for what implements an interface by its name."""
        if "this" in header:
            at = header.index("this")
            given = tuple(parameter(part, self._names) for part in split(header[at + 2 : -1], ","))
            header, marks = [*header[:at], "Item"], replace(marks, parameters=given)
        first, *others = split(header, ",")
        names, value, kinds, number = [first[-1], *(part[-1] for part in others)], first[:-1], {"field"}, ""
        if self._peek() == "{":
            kinds, marks = self._accessors(marks)
            if self._peek() == "=":  # what an automatic property begins with
                self._body()
        elif self._peek() == "=>":
            kinds = {"get"}
            self._body()
        else:
            while self._peek() in ("=", ","):
                if self._take() == "=":
                    number = "".join(self._until(",", ";"))
                else:
                    names.append(self._until(",", ";", "=")[0])
            self._take()
        if value and value[-1] == ".":
            return []
        marks = replace(marks, kinds=frozenset(kinds), value=spell(value, self._names), number=number)
        return [replace(marks, name=name) for name in names]

    def _accessors(self, marks: Member) -> tuple[set[str], Member]:
        self._take()
        kinds, closed, failing = set[str](), set[str](), set[str]()
        while self._peek() not in ("", "}"):
            obsolete, modifiers = self._attributes(), self._modifiers()
            kind = self._take().replace("init", "set")
            kinds.add(kind)
            if modifiers & {"private", "internal"} and "protected" not in modifiers:
                closed.add(kind)
            if obsolete == "error":
                failing.add(kind)
            self._body() if self._peek() in ("{", "=>") else self._take()
        self._take()
        return kinds, replace(marks, closed=frozenset(closed), failing=frozenset(failing))
