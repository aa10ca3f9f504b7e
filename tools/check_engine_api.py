"""Hold every member of the engine that the Unity package uses against the engine's published sources.

python tools/check_engine_api.py --engine 6000.0 UnityCsReference [PACKAGE ...]

Folders: a checkout of Unity's reference source at the tag of that engine, and the sources of the packages that ours
can use: URP and its core, OpenXR, XR management, the Input System, the test framework. The tests' stand-ins say what is
used: the package is compiled against them for the editor, a Quest and a PC, and what its assemblies refer to is looked
up by name and signature. Exits 1 where something is used that is not there, or not so.
"""

import argparse
import sys
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import reduce
from pathlib import Path

import csharp_source
from csharp_source import Declared, Member
from engine_use import CSharp, Used, engine_symbols, named, used_members
from package_compiler import ENGINES
from rich.console import Console

YEARS = range(2017, 2024)  # versions of engines before 6000
SYMBOLS = ("UNITY_EDITOR", "ENABLE_VR", "ENABLE_VR_MODULE", "ENABLE_XR_MODULE", "ENABLE_INPUT_SYSTEM")


@dataclass(frozen=True)
class Found:
    """The result for one member."""

    used: Used
    outcome: str  # same, deprecated, different, absent, unknown
    what: str = ""


def lineage(types: dict[str, Declared], name: str) -> Iterator[tuple[Declared, dict[str, str]]]:
    """A type and those that it inherits from, as far as they are among the sources, with what stands for `!0` there."""
    waiting, seen = [(name, dict[str, str]())], set[str]()
    while waiting:
        at, given = waiting.pop(0)
        if at in types and at not in seen:
            seen.add(at)
            yield types[at], given
            for base in types[at].bases:
                inside = base[base.index("<") + 1 : -1].split(",") if "<" in base else []
                own = {f"!{i}": given.get(part, part) for i, part in enumerate(inside)}
                waiting.append((_resolve(types, at, base), own))


def _resolve(types: dict[str, Declared], within: str, base: str) -> str:
    """A base type's whole name: the nearest in the namespaces about, else the only one of that name."""
    arity = base.count(",") + 1 if "<" in base else 0
    short = base.split("<")[0] + (f"`{arity}" if arity else "")
    parts = within.split(".")
    for depth in range(len(parts) - 1, -1, -1):
        if (candidate := ".".join([*parts[:depth], short])) in types:
            return candidate
    others = [name for name in types if name.endswith(f".{short}")]
    return others[0] if len(others) == 1 else ""


def look_up(types: dict[str, Declared], used: Used) -> Found:
    """A member in the sources."""
    if used.type not in types:
        return Found(used, "unknown", "no source has the type")
    owner = types[used.type]
    if used.kind == "type" or (used.kind == "constructor" and _is_plain(owner, used)):
        return _judge(used, owner.is_open, owner.obsolete)
    chain = [(owner, dict[str, str]())] if used.kind == "constructor" else list(lineage(types, used.type))
    candidates = [
        replace(member, value=given.get(member.value, member.value))
        for declared, given in chain
        for member in declared.members
        if member.name == used.name and ("constructor" in member.kinds) == (used.kind == "constructor")
    ]
    for member in sorted(candidates, key=lambda each: not each.is_open):
        if _is_same(member, used):
            return _judge(
                used, member.is_open and used.kind not in member.closed, _obsolete(member, used), owner.obsolete
            )
    if candidates:
        return Found(used, "different", "; ".join(sorted({describe(member) for member in candidates})))
    return Found(used, "absent", f"{used.type} has no {used.name or 'such constructor'}")


def _is_plain(owner: Declared, used: Used) -> bool:
    """A constructor without parameters that nobody has to declare, or that of a delegate."""
    declares = any("constructor" in member.kinds and not member.is_static for member in owner.members)
    return owner.kind == "delegate" or (not used.parameters and (not declares or owner.kind == "struct"))


def _obsolete(member: Member, used: Used) -> str:
    return "error" if used.kind in member.failing else member.obsolete


def _judge(used: Used, is_open: bool, *obsolete: str) -> Found:
    if not is_open:
        return Found(used, "different", "it is not public")
    if "error" in obsolete:
        return Found(used, "different", "it is obsolete, and an error to use")
    return Found(used, "deprecated" if "warning" in obsolete else "same")


def _is_same(member: Member, used: Used) -> bool:
    wanted = {used.kind, "field"} if used.kind in ("get", "set", "add", "remove") else {used.kind}
    if used.kind == "field":
        wanted = {"field", "get"}
    if used.kind in ("enum", "const"):
        return bool(member.kinds & {"enum", "const"}) and (
            used.kind == "const" or _is_number(member.number, used.value)
        )
    return (
        bool(member.kinds & wanted)
        and member.is_static == used.is_static
        and member.value == used.value
        and all(theirs.endswith(" =") for theirs in member.parameters[len(used.parameters) :])
        and len(member.parameters) >= len(used.parameters)
        and all(_takes(theirs, ours) for theirs, ours in zip(member.parameters, used.parameters, strict=False))
    )


def _takes(theirs: str, ours: str) -> bool:
    """Whether types and passing agree, and arguments left out here are optional. mcs compiles `in` as nothing."""
    theirs = theirs.removeprefix("in ")
    return theirs.removesuffix(" =") == ours.removesuffix(" =") and (theirs.endswith(" =") or not ours.endswith(" ="))


def _is_number(written: str, value: str) -> bool:
    """Whether an enum's value is the one; where it is not written in numbers, its name decides."""
    try:
        return _number(written) == int(value)
    except ValueError:
        return True


def _number(written: str) -> int:
    for sign, combine in (("|", int.__or__), ("<<", int.__lshift__), ("+", int.__add__)):
        if sign in written:
            return reduce(combine, (_number(part) for part in written.split(sign)))
    return int(written.strip("()").rstrip("uUlL"), 0)


def describe(member: Member) -> str:
    """A declaration in words."""
    inside = f"({', '.join(member.parameters)})" if member.kinds & {"method", "constructor"} else ""
    access = "" if member.is_open else "closed "
    number = f" = {member.number}" if member.number else ""
    kinds = "/".join(sorted(member.kinds))
    return f"{access}{'static ' * member.is_static}{kinds} {member.value} {member.name}{inside}{number}"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("sources", nargs="+", type=Path, help="folders with C# sources")
    parser.add_argument("--engine", choices=list(ENGINES), default=next(iter(ENGINES)), help="whose sources they are")
    parser.add_argument("--all", action="store_true", help="list what is the same too")
    arguments = parser.parse_args()
    for folder in arguments.sources:
        if not folder.is_dir():
            parser.error(f"{folder}: no such folder, expected one with C# sources")
    years = [f"UNITY_{year}_{part}_OR_NEWER" for year in YEARS for part in range(1, 5)]
    types = csharp_source.read(arguments.sources, {*SYMBOLS, *years, *engine_symbols(arguments.engine)})
    members = named(used_members(CSharp(), arguments.engine), arguments.engine)
    found = [look_up(types, used) for used in members]
    return tell(found, Console(soft_wrap=True, highlight=False), everything=arguments.all)


def tell(found: list[Found], console: Console, *, everything: bool) -> int:
    """Prints what came of it; the exit status."""
    for each in found:
        if each.outcome != "same" or everything:
            console.print(f"{each.outcome}: {each.used}{': ' * bool(each.what)}{each.what}", markup=False)
    counts = Counter(each.outcome for each in found)
    console.print(f"{len(found)} members: " + ", ".join(f"{count} {name}" for name, count in counts.most_common()))
    return 1 if counts["different"] or counts["absent"] else 0


if __name__ == "__main__":
    sys.exit(main())
