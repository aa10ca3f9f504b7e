"""Generate what all readers share: layouts from schemas/muaavatar.fbs, numbers from limits.py; --check compares them.

They are data: which fields each table has, in slot order. python/mua/asset/flatbuffer.py reads and writes by layout.py,
unity-package's Parser.cs reads by Layouts.cs, the browser player's parser.js by layout.js. Only the grammar that the
schema uses is understood; anything else stops with its line.
"""

import json
import re
import runpy
import sys
from pathlib import Path

import generated

ROOT = Path(__file__).resolve().parents[1]
SCHEMA = ROOT / "schemas" / "muaavatar.fbs"
LAYOUT = ROOT / "python" / "mua" / "asset" / "layout.py"
LAYOUTS = ROOT / "unity-package" / "Runtime" / "Format" / "Layouts.cs"
LAYOUT_JS = ROOT / "python" / "mua" / "web" / "format" / "layout.js"
LIMITS = ROOT / "python" / "mua" / "limits.py"
LIMITS_CS = LAYOUTS.with_name("Limits.cs")
LIMITS_JS = LAYOUT_JS.with_name("limits.js")
KINDS = {
    "bool": "Flag",
    "ubyte": "U8",
    "ushort": "U16",
    "uint": "U32",
    "float": "F32",
    "double": "F64",
    "string": "Text",
}

ENUM = re.compile(r"enum (\w+) : ubyte \{ ([\w, ]+) \}")
FIELD = re.compile(r"(\w+): (\[?\w+\]?)( \([\w:, ]+\))?;")
HEADER = '''"""Generated from schemas/muaavatar.fbs by tools/gen_layout.py; do not edit."""

from typing import NamedTuple


class Field(NamedTuple):
    """One slot of a table: `kind` is a scalar, `string`, an enum or a table; `vector` says whether there are many."""

    name: str
    kind: str
    vector: bool = False
    required: bool = False
    align: int = 0


'''


def parse(schema: str) -> tuple[str, dict[str, list[str]], dict[str, list[str]], str]:
    """The file identifier, enums, tables (as source lines of fields) and root type of a schema."""
    enums: dict[str, list[str]] = {}
    tables: dict[str, list[str]] = {}
    identifier = root = table = ""
    for number, raw in enumerate(schema.splitlines(), 1):
        line = raw.split("//")[0].strip()
        if not line or line.startswith(("namespace", "file_extension")):
            continue
        if found := ENUM.fullmatch(line):
            enums[found[1]] = found[2].split(", ")
        elif line.startswith("table "):
            table = line.split()[1]
            tables[table] = []
        elif found := FIELD.fullmatch(line):
            tables[table].append(field_source(*found.groups()))
        elif line.startswith("root_type"):
            root = line.split()[1].rstrip(";")
        elif line.startswith("file_identifier"):
            identifier = line.split('"')[1]
        elif line != "}":
            sys.exit(f"{SCHEMA}:{number}: not understood: {line}")
    return identifier, enums, tables, root


def field_source(name: str, kind: str, attributes: str | None) -> str:
    """A Field as Python source."""
    align = re.search(r"force_align: (\d+)", attributes or "")
    options = [f'"{name}"', f'"{kind.strip("[]")}"']
    options += ["vector=True"] if kind.startswith("[") else []
    options += ["required=True"] if "required" in (attributes or "") else []
    options += [f"align={align[1]}"] if align else []
    return f"Field({', '.join(options)})"


def quoted(values: list[str]) -> str:
    return '", "'.join(values)


def generate() -> str:
    identifier, enums, tables, root = parse(SCHEMA.read_text())
    lines = [f'IDENTIFIER = b"{identifier}"', f'ROOT = "{root}"', "", "ENUMS = {"]
    for name, values in enums.items():
        lines += [f'    "{name}": ("{values[0]}",),' if len(values) == 1 else f'    "{name}": ("{quoted(values)}"),']
    lines += ["}", "", "TABLES = {"]
    for name, fields in tables.items():
        one = [f'    "{name}": ({fields[0]},),']
        several = [f'    "{name}": (', *(f"        {field}," for field in fields), "    ),"]
        lines += one if len(fields) == 1 else several
    return HEADER + "\n".join([*lines, "}", ""])


CSHARP_HEADER = """// Generated from schemas/muaavatar.fbs by tools/gen_layout.py; do not edit.

namespace Mua.Format
{
    internal static class Layouts
    {
"""


def generate_csharp() -> str:
    """The layouts for the C# reader; a table follows the tables it points to."""
    identifier, enums, tables, root = parse(SCHEMA.read_text())
    lines = [f'public const string Identifier = "{identifier}";', ""]
    for name, values in enums.items():
        lines += [f'public static readonly string[] {name} = {{ "{quoted(values)}" }};']
    for name, fields in tables.items():
        lines += ["", f"public static readonly Layout {name} = new Layout("]
        lines += [f"    {field_csharp(field, enums)}," for field in fields]
        lines[-1] = lines[-1][:-1] + ");"
    lines += ["", f"public static readonly Layout Root = {root};"]
    body = "".join(f"        {line}\n" if line else "\n" for line in lines)
    return f"{CSHARP_HEADER}{body}    }}\n}}\n"


def field_csharp(source: str, enums: dict[str, list[str]]) -> str:
    """A Field as C# source, from its Python source."""
    name, kind, *options = source.removeprefix("Field(").removesuffix(")").replace('"', "").split(", ")
    if kind in enums:
        options.append(f"names={kind}")
    elif kind not in KINDS:
        options.append(f"table={kind}")
    kind = "Enum" if kind in enums else KINDS.get(kind, "Table")
    named = [option.replace("=", ": ").replace("True", "true") for option in options]
    arguments = ", ".join([f'"{name}"', f"Kind.{kind}", *named])
    return f"new Field({arguments})"


JAVASCRIPT = """// Generated from schemas/muaavatar.fbs by tools/gen_layout.py; do not edit.

export const IDENTIFIER = "{identifier}";
export const ROOT = "{root}";

/** @type {{Record<string, string[]>}} */
export const ENUMS = {enums};

/** @type {{Record<string, import("./parser.js").Field[]>}} */
export const TABLES = {{
{tables}
}};
"""


def generate_javascript() -> str:
    """The layouts for the browser player's reader."""
    identifier, enums, tables, root = parse(SCHEMA.read_text())
    listed = [f"  {name}: [\n{fields_javascript(fields)}  ]," for name, fields in tables.items()]
    return JAVASCRIPT.format(identifier=identifier, root=root, enums=json.dumps(enums), tables="\n".join(listed))


def fields_javascript(sources: list[str]) -> str:
    """Fields as JavaScript source, a line each, from their Python source."""
    lines = []
    for source in sources:
        name, kind, *options = source.removeprefix("Field(").removesuffix(")").split(", ")
        named = [option.replace("=", ": ").replace("True", "true") for option in options]
        lines.append(f"    {{ {', '.join([f'name: {name}', f'kind: {kind}', *named])} }},\n")
    return "".join(lines)


def limits() -> dict[str, int | float]:
    """The numbers of limits.py."""
    return {name: value for name, value in runpy.run_path(str(LIMITS)).items() if name.isupper()}


def limits_csharp() -> str:
    lines = [
        f"public const {type(value).__name__.replace('float', 'double')} "
        f"{''.join(part.capitalize() for part in name.split('_'))} = {value!r};"
        for name, value in limits().items()
    ]
    body = "".join(f"        {line}\n" for line in lines)
    head = "// Generated from python/mua/limits.py by tools/gen_layout.py; do not edit.\n\nnamespace Mua.Format\n{\n"
    return f"{head}    internal static class Limits\n    {{\n{body}    }}\n}}\n"


def limits_javascript() -> str:
    lines = [f"export const {name} = {value!r};\n" for name, value in limits().items()]
    return "// Generated from python/mua/limits.py by tools/gen_layout.py; do not edit.\n\n" + "".join(lines)


def contents() -> dict[Path, str]:
    """What each file is to hold."""
    layouts = {LAYOUT: generate(), LAYOUTS: generate_csharp(), LAYOUT_JS: generate_javascript()}
    return layouts | {LIMITS_CS: limits_csharp(), LIMITS_JS: limits_javascript()}


if __name__ == "__main__":
    generated.run("gen_layout.py", __doc__, contents())
