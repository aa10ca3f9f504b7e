"""Types and their members as C# sources declare them, read by tree-sitter.

Types of values are kept without their namespaces, type parameters as `!0` of a type and `!!0` of a method, so that a
declaration can be compared with one from an assembly.
"""

import re
from collections.abc import Collection, Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

import tree_sitter_c_sharp
from tree_sitter import Language, Node, Parser

CSHARP = Parser(Language(tree_sitter_c_sharp.language()))
OPERATORS = {
    "+": "op_Addition", "-": "op_Subtraction", "*": "op_Multiply", "/": "op_Division", "==": "op_Equality",
    "!=": "op_Inequality", "implicit": "op_Implicit", "explicit": "op_Explicit",
}  # fmt: skip
UNARY = {"+": "op_UnaryPlus", "-": "op_UnaryNegation"}
SYSTEM = {
    "Boolean": "bool", "Byte": "byte", "Int16": "short", "UInt16": "ushort", "Int32": "int", "UInt32": "uint",
    "Int64": "long", "UInt64": "ulong", "Single": "float", "Double": "double", "String": "string",
}  # fmt: skip
TYPES = {f"{kind}_declaration" for kind in ("class", "struct", "interface", "enum", "record")}
PASSED = re.compile(r"\b(ref|out|in)\b")
BARE = re.compile(r"\b(?:this|ref|out|in|params|scoped|readonly)\b")


@dataclass(frozen=True)
class Member:
    """A declaration in a type."""

    kinds: frozenset[str] = frozenset()  # its uses: constructor, method, get, set, field, add, remove, enum, const
    name: str = ""
    value: str = ""  # type of what it holds or returns
    parameters: tuple[str, ...] = ()  # `out float`, with ` =` after one that a call may leave out
    is_static: bool = False
    is_open: bool = True  # public, or protected
    closed: frozenset[str] = frozenset()  # accessors that are neither
    obsolete: str = ""  # "", "warning" or "error"
    failing: frozenset[str] = frozenset()  # accessors that are an error to use
    number: str = ""  # value of an enum member or a constant, as written


@dataclass
class Declared:
    """A type, with the parts of all its files."""

    name: str  # with its namespace and the types about it, separated by dots; `n for n type parameters
    kind: str
    bases: list[str] = field(default_factory=list)
    members: list[Member] = field(default_factory=list)
    obsolete: str = ""
    is_open: bool = False


def read(folders: Collection[Path], symbols: Collection[str]) -> dict[str, Declared]:
    """The types below folders, by name, of the code that is compiled with `symbols`."""
    found: dict[str, Declared] = {}
    for folder in folders:
        for path in sorted(folder.rglob("*.cs")):
            _space(syntax(path.read_text(encoding="utf-8-sig", errors="replace"), symbols), "", {}, found)
    return found


def syntax(text: str, symbols: Collection[str]) -> Node:
    """The syntax tree of the branches of a file that are compiled with `symbols`."""
    return CSHARP.parse("\n".join(_compiled(text, symbols)).encode()).root_node


def accesses(node: Node) -> Iterator[str]:
    """Every `Type.Name`, or `value.Name`, below a node."""
    if node.type in ("member_access_expression", "qualified_name"):
        yield ".".join(re.findall(r"\w+", _text(node))[-2:])
    for child in node.named_children:
        yield from accesses(child)


def _compiled(text: str, symbols: Collection[str]) -> Iterator[str]:
    branches: list[tuple[bool, bool]] = []  # of each open #if: whether this branch is compiled, whether one was
    for line in text.splitlines():
        word, _, rest = line.strip().removeprefix("#").strip().partition(" ")
        if not line.strip().startswith("#"):
            if all(is_compiled for is_compiled, _ in branches):
                yield line
        elif word == "if":
            branches.append((holds(rest, symbols),) * 2)
        elif word in ("elif", "else"):
            is_next = not branches[-1][1] and (word == "else" or holds(rest, symbols))
            branches[-1] = (is_next, is_next or branches[-1][1])
        elif word == "endif":
            branches.pop()


def holds(condition: str, symbols: Collection[str]) -> bool:
    """Whether a condition of the preprocessor holds."""
    words = re.findall(r"\w+|&&|\|\||==|!=|[!()]", condition.partition("//")[0])
    signs = {"&&": " and ", "||": " or ", "!": " not ", "true": "True", "false": "False"}
    python = "".join(signs.get(word) or (str(word in symbols) if re.match(r"\w", word) else word) for word in words)
    return bool(eval(python, {"__builtins__": {}}))  # only True, False, and, or, not, == and brackets


def _space(node: Node, prefix: str, names: dict[str, str], found: dict[str, Declared]) -> None:
    """The declarations of a file or a namespace."""
    for child in node.named_children:
        if child.type == "using_directive" and (name := child.child_by_field_name("name")):
            names = {**names, _text(name): spell(child.named_children[-1], {})}
        elif child.type in ("namespace_declaration", "file_scoped_namespace_declaration"):
            inner = f"{prefix}{_text(child.child_by_field_name('name'))}."
            body = child.child_by_field_name("body")
            if body is None:
                prefix = inner
            else:
                _space(body, inner, names, found)
        elif child.type in (*TYPES, "delegate_declaration"):
            _type(child, prefix, names, found)


def _type(node: Node, prefix: str, outer: dict[str, str], found: dict[str, Declared]) -> None:
    given = _type_parameters(node)
    name = f"{prefix}{_text(node.child_by_field_name('name'))}" + (f"`{len(given)}" if given else "")
    made = found.setdefault(name, Declared(name, node.type.removesuffix("_declaration")))
    made.obsolete, made.is_open = made.obsolete or _obsolete(node), made.is_open or _is_open(node)
    names = outer | {each: f"!{i}" for i, each in enumerate(given)}
    if made.kind not in ("enum", "delegate"):
        for bases in _children(node, "base_list"):
            made.bases += [spell(base, names) for base in bases.named_children]
    body = node.child_by_field_name("body")
    for child in body.named_children if body else []:
        if child.type in (*TYPES, "delegate_declaration"):
            _type(child, f"{name}.", names, found)
        elif child.type == "enum_member_declaration":
            made.members.append(_enum_member(child, made))
        else:
            made.members += _members(child, made, names)


def _enum_member(node: Node, made: Declared) -> Member:
    value = node.child_by_field_name("value")
    last = made.members[-1].number if made.members else ""
    number = _text(value) if value else f"{last}+1" if last else "0"
    name = _text(node.child_by_field_name("name"))
    return Member(frozenset({"enum"}), name, made.name, is_static=True, obsolete=_obsolete(node), number=number)


def _members(node: Node, owner: Declared, names: dict[str, str]) -> list[Member]:
    """The members that a declaration declares; none of one that implements an interface by its name."""
    modifiers = _modifiers(node)
    if _children(node, "explicit_interface_specifier"):
        return []
    marks = Member(
        obsolete=_obsolete(node),
        is_open=_is_open(node) or owner.kind == "interface",
        is_static=bool(modifiers & {"static", "const"}),
    )
    if node.type in ("field_declaration", "event_field_declaration"):
        return _fields(node, marks, names, is_const="const" in modifiers)
    if node.type in ("property_declaration", "indexer_declaration", "event_declaration"):
        return [_property(node, marks, names)]
    if node.type in _METHODS:
        return [_method(node, marks, names)]
    return []


_METHODS = {
    "method_declaration": "method",
    "constructor_declaration": "constructor",
    "operator_declaration": "method",
    "conversion_operator_declaration": "method",
}


def _fields(node: Node, marks: Member, names: dict[str, str], *, is_const: bool) -> list[Member]:
    (declared,) = _children(node, "variable_declaration")
    value = spell(declared.child_by_field_name("type"), names)
    is_event = node.type == "event_field_declaration"
    kinds = frozenset({"add", "remove"} if is_event else {"const" if is_const else "field"})
    return [
        replace(
            marks,
            kinds=kinds,
            name=_text(one.child_by_field_name("name")),
            value=value,
            number=_text(one.named_children[-1]) if len(one.named_children) > 1 and not is_event else "",
        )
        for one in _children(declared, "variable_declarator")
    ]


def _property(node: Node, marks: Member, names: dict[str, str]) -> Member:
    accessors = node.child_by_field_name("accessors")
    kinds, closed, failing = set[str](), set[str](), set[str]()
    for accessor in accessors.named_children if accessors else []:
        kind = _text(accessor.child_by_field_name("name")).replace("init", "set")
        kinds.add(kind)
        if _modifiers(accessor) & {"private", "internal"} and "protected" not in _modifiers(accessor):
            closed.add(kind)
        if _obsolete(accessor) == "error":
            failing.add(kind)
    return replace(
        marks,
        kinds=frozenset(kinds or {"get"}),
        name="Item" if node.type == "indexer_declaration" else _text(node.child_by_field_name("name")),
        value=spell(node.child_by_field_name("type"), names),
        parameters=_parameters(node, names),
        closed=frozenset(closed),
        failing=frozenset(failing),
    )


def _method(node: Node, marks: Member, names: dict[str, str]) -> Member:
    names = names | {each: f"!!{i}" for i, each in enumerate(_type_parameters(node))}
    parameters = _parameters(node, names)
    name = node.child_by_field_name("name")
    sign = node.child_by_field_name("operator")
    value = node.child_by_field_name("returns") or node.child_by_field_name("type")
    if node.type == "conversion_operator_declaration":
        name_text = OPERATORS["implicit" if any(_text(child) == "implicit" for child in node.children) else "explicit"]
    elif sign is not None:
        word = _text(sign)
        name_text = UNARY[word] if len(parameters) == 1 and word in UNARY else OPERATORS.get(word, word)
    else:
        name_text = "" if node.type == "constructor_declaration" else _text(name)
    kinds = frozenset({_METHODS[node.type]})
    return replace(
        marks, kinds=kinds, name=name_text, value=spell(value, names) if value else "", parameters=parameters
    )


def _parameters(node: Node, names: dict[str, str]) -> tuple[str, ...]:
    listed = node.child_by_field_name("parameters")
    if listed is None:
        return ()
    found = [_parameter(child, names) for child in listed.named_children if child.type == "parameter"]
    if any(child.type == "params" for child in listed.children):  # its type and name stand in the list itself
        found.append(spell(listed.child_by_field_name("type"), names))
    return tuple(found)


def _parameter(node: Node, names: dict[str, str]) -> str:
    written = "".join(f"{_text(child)} " for child in _children(node, "modifier"))
    passed = PASSED.search(written)
    optional = " =" if any(child.type in ("=", "equals_value_clause") for child in node.children) else ""
    return (f"{passed[1]} " if passed else "") + spell(node.child_by_field_name("type"), names) + optional


def spell(node: Node | None, names: dict[str, str]) -> str:
    """A type as one word, without namespaces; `names` says what stands for some."""
    text = re.sub(r"\s+", "", BARE.sub("", _text(node)))
    text = re.sub(r"\w+(?:\.|::)(?=\w)", "", text)
    text = re.sub(r"\w+", lambda word: names.get(word[0], SYSTEM.get(word[0], word[0])), text)
    return re.sub(r"([\w.<>!,\[\]]+)\?", r"Nullable<\1>", text)


def _type_parameters(node: Node) -> list[str]:
    listed = _children(node, "type_parameter_list")
    return [_text(one.child_by_field_name("name")) for one in _children(listed[0], "type_parameter")] if listed else []


def _modifiers(node: Node) -> set[str]:
    return {_text(child) for child in _children(node, "modifier")}


def _is_open(node: Node) -> bool:
    return bool(_modifiers(node) & {"public", "protected"})


def _obsolete(node: Node) -> str:
    """Whether a declaration is obsolete: as a warning, or as an error."""
    for attributes in _children(node, "attribute_list"):
        if match := re.search(r"\bObsolete(?:Attribute)?\b(\(.*)?", _text(attributes), re.DOTALL):
            return "error" if re.search(r",\s*(?:error:\s*)?true\s*\)", match[1] or "") else "warning"
    return ""


def _children(node: Node, kind: str) -> list[Node]:
    return [child for child in node.children if child.type == kind]


def _text(node: Node | None) -> str:
    return node.text.decode() if node is not None and node.text else ""
