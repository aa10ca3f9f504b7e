"""WGSL as slangc writes it, in fewer bytes: the same statements with short local names, types and literals.

A function of several entry points gets the same text in each, so that a module of them compresses well.
"""

import re
from collections.abc import Iterator
from itertools import count, pairwise
from string import ascii_letters

import numpy as np

TOKEN = re.compile(r"[A-Za-z_]\w*|\d+(?:\.\d+)?(?:[eE][+-]?\d+)?[fiu]?|->|&&|\|\||<<|>>|[<>=!+*/%&|^-]=|\S")
ZERO = re.compile(r"\b(vec\d<\w+>)\(vec\d<i32>\(i32\(0\)\)\)")
BLOCK = re.compile(r"\bSLANG_ParameterGroup_(\w+)_std140_0\b")
TYPE = re.compile(r"\b(vec\d|mat\dx\d)<(f|u|i)32>")
REFERENCE = re.compile(r"^(\d+)-(\d+)$", re.MULTILINE)
OPEN, CLOSE = "([{", ")]}"
ASSIGNED = [f"{sign}=" for sign in "<>=!+*/%&|^-"]
JOINED = {"--", "++", "&&", "||", "//", "/*", "->", *ASSIGNED}  # what two tokens without a space would be read as
WORD = re.compile(r"\w[\w.]*")
OPERATOR = re.compile(r"[<=!+*/%&|^-]+|>>|>=")  # not a lone >, which may end a type that is called
NUMBER = re.compile(r"\d[\w.]*|i32\(-\d+\)")
BEFORE_GROUP, AFTER_GROUP = {"(", "[", ",", "=", "return"}, {")", "]", ",", ";"}
COMPARISONS = {"<", ">", ">=", "<<", ">>"}  # of two arguments, without parentheses, may be read as a template's list
ENDLESS, LEAVE = ["for", "(", ";", ";", ")", "{", "if", "("], ["{", "}", "else", "{", "break", ";", "}"]
END_OF_FUNCTION = ["return", ";", "}"]


def small(code: str) -> str:
    """The code with a line for each declaration of a module."""
    for long, short in ((BLOCK, r"\1"), (ZERO, r"\1()"), (TYPE, r"\1\2")):
        code = long.sub(short, code)
    tokens = TOKEN.findall(code)
    for step in (_short_literals, _with_conditions, _with_operators, _without_groups):
        tokens = step(tokens)
    return "\n".join(_text(_named(_without_types(one))) for one in _declarations(tokens))


def _short_literals(tokens: list[str]) -> list[str]:
    """u32(4) as 4u, an index or a length as a bare number, and floats by their shortest digits."""
    found: list[str] = []
    at = 0
    while at < len(tokens):
        token = tokens[at]
        if token in ("u32", "i32") and tokens[at + 1] == "(" and tokens[at + 2].isdigit() and tokens[at + 3] == ")":
            bare = found[-1] == "[" or tokens[at + 4].startswith(">")
            found.append(tokens[at + 2] + ("" if bare else token[0]))
            at += 4
        else:
            found.append(_short_float(token) if re.fullmatch(r"\d.*f", token) else token)
            at += 1
    return found


def _short_float(literal: str) -> str:
    written = np.format_float_scientific if "e" in literal else np.format_float_positional
    return written(np.float32(literal[:-1]), trim="-").replace("e-0", "e-") + "f"


def _without_groups(tokens: list[str]) -> list[str]:
    """Without parentheses about a whole argument, index or value, or about what binds as tightly as they do."""
    partner = _partners(tokens)
    dropped: set[int] = set()
    for start, end in partner.items():
        before, inside, after = tokens[start - 1], tokens[start + 1 : end], tokens[end + 1 : end + 2]
        if tokens[start] != "(" or not (before in BEFORE_GROUP or OPERATOR.fullmatch(before)):
            continue
        compares = "," in (before, *after) and not COMPARISONS.isdisjoint(inside)
        whole = before in BEFORE_GROUP and AFTER_GROUP.issuperset(after) and not compares
        if whole or _is_place(inside):
            dropped |= {start, end}
    left = [token for at, token in enumerate(tokens) if at not in dropped]
    return _without_groups(left) if dropped else left


def _is_place(tokens: list[str]) -> bool:
    """Whether this is one number or name, or what follows it: members, elements, arguments of a call."""
    partner = _partners(tokens)
    at = 1
    while at < len(tokens):
        if tokens[at] == ".":
            at += 2
        elif tokens[at] in "([":
            at = partner[at] + 1
        else:
            return False
    return WORD.fullmatch(tokens[0]) is not None


def _with_conditions(tokens: list[str]) -> list[str]:
    """Endless loops that begin with their test as loops with a condition."""
    partner = _partners(tokens)
    found: list[str] = []
    at = 0
    while at < len(tokens):
        inside = at + len(ENDLESS)
        if tokens[at:inside] == ENDLESS:
            end = partner[inside - 1]
            if tokens[end + 1 : end + 1 + len(LEAVE)] == LEAVE:
                found += ["for", "(", ";", *tokens[inside:end], ";", ")", "{"]
                at = end + 1 + len(LEAVE)
                continue
        found.append(tokens[at])
        at += 1
    return found


def _with_operators(tokens: list[str]) -> list[str]:
    """A variable that both branches of a condition set as an operation on truth values or a choice of two numbers."""
    partner = _partners(tokens)
    found: list[str] = []
    at = 0
    while at < len(tokens):
        if tokens[at] == "if" and (choice := _choice(tokens, at, partner)):
            name, value, at = choice
            if found[-5:-2] == ["var", name, ":"]:
                del found[-4:]
            found += [name, "=", *value, ";"]
        else:
            found.append(tokens[at])
            at += 1
    return found


def _choice(tokens: list[str], at: int, partner: dict[int, int]) -> tuple[str, list[str], int] | None:
    """The variable that if and else at a place set, the value that it gets, and where they end."""
    end = partner[at + 1]
    condition, then = tokens[at + 1 : end + 1], _assigned(tokens, end + 1, partner)
    end = partner[end + 1]
    if then is None or tokens[end + 1] != "else":
        return None
    other = _assigned(tokens, end + 2, partner)
    if other is None or other[0] != then[0]:
        return None
    (name, *yes), (_, *no) = then, other
    end = partner[end + 2] + 1
    if no == ["false"]:
        return name, [*condition, "&&", "(", *yes, ")"], end
    if yes == ["true"]:
        return name, [*condition, "||", "(", *no, ")"], end
    if all(NUMBER.fullmatch("".join(value)) for value in (yes, no)):
        return name, ["select", "(", *no, ",", *yes, ",", *condition, ")"], end
    return None


def _assigned(tokens: list[str], at: int, partner: dict[int, int]) -> list[str] | None:
    """The variable and value of a block that does no more than set one."""
    block = tokens[at + 1 : partner[at]]
    alone = len(block) > 3 and block[1] == "=" and block.index(";") == len(block) - 1
    return [block[0], *block[2:-1]] if alone else None


def _partners(tokens: list[str]) -> dict[int, int]:
    """Where each bracket closes."""
    found, opened = {}, []
    for at, token in enumerate(tokens):
        if token in OPEN:
            opened.append(at)
        elif token in CLOSE:
            found[opened.pop()] = at
    return found


def _declarations(tokens: list[str]) -> Iterator[list[str]]:
    """Functions, structs and variables of a module."""
    depth, first = 0, 0
    for at, token in enumerate(tokens):
        depth += (token in OPEN) - (token in CLOSE)
        following = tokens[at + 1 : at + 2]
        if depth == 0 and (token == ";" or (token == "}" and following != [";"])):
            yield tokens[first : at + 1]
            first = at + 1


def _without_types(tokens: list[str]) -> list[str]:
    """A function without the types of variables that begin with a value, and without its last return."""
    if "fn" not in tokens:
        return tokens
    if tokens[-3:] == END_OF_FUNCTION:
        tokens = [*tokens[:-3], "}"]
    found: list[str] = []
    at = 0
    while at < len(tokens):
        found.append(tokens[at])
        if tokens[at - 1] in ("var", "const") and tokens[at + 1] == ":":
            end = next(i for i in range(at, len(tokens)) if tokens[i] in ("=", ";"))
            if tokens[end] == "=":
                at = end - 1
        at += 1
    return found


def _named(tokens: list[str]) -> list[str]:
    """A function with its arguments and variables named a, b and so on, in the order of their declarations."""
    if "fn" not in tokens:
        return tokens
    start = tokens.index("fn") + 2
    end = _partners(tokens)[start]
    declared = [tokens[at - 1] for at in range(start, end) if tokens[at] == ":"]
    declared += [tokens[at] for at in range(end, len(tokens)) if tokens[at - 1] in ("var", "let", "const")]
    names = dict(zip(dict.fromkeys(declared), _names(), strict=False))
    return [token if tokens[at - 1] == "." else names.get(token, token) for at, token in enumerate(tokens)]


def _names() -> Iterator[str]:
    """The letters, then a1, b1 and so on, none of which is a word of WGSL."""
    yield from ascii_letters
    for number in count(1):
        yield from (f"{letter}{number}" for letter in ascii_letters)


def _text(tokens: list[str]) -> str:
    """The tokens with a space only where two would be read as one."""
    found = tokens[:1]
    for before, token in pairwise(tokens):
        words = (before[-1].isalnum() or before[-1] == "_") and (token[0].isalnum() or token[0] == "_")
        found.append(" " * (words or before[-1] + token[0] in JOINED) + token)
    return "".join(found)


def with_references(code: str, other: str) -> str:
    """The code with 4-7 in place of lines 4 to 6, from 0, of the other."""
    places = {line: at for at, line in enumerate(other.split("\n"))}
    found: list[str | range] = []
    for line in code.split("\n"):
        at = places.get(line)
        last = found[-1] if found else ""
        if at is not None and isinstance(last, range) and last.stop == at:
            found[-1] = range(last.start, at + 1)
        else:
            found.append(line if at is None else range(at, at + 1))
    return "\n".join(f"{one.start}-{one.stop}" if isinstance(one, range) else one for one in found)


def without_references(code: str, other: str) -> str:
    """The code of with_references; the player's is withLines of python/mua/web/shader.js."""
    lines = other.split("\n")
    return REFERENCE.sub(lambda found: "\n".join(lines[int(found[1]) : int(found[2])]), code)
