"""Write python/mua/web/wgsl, every kernel and draw for browsers; --check says whether it is up to date.

A file of ComputeShaders or of the desktop player becomes an ES module with an object for each entry point: its WGSL,
and what it binds by name. A module that is loaded on demand takes lines from an entry point that is loaded before.
"""

import json
import re
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import checkout  # noqa: F401
from check_shaders import entry_points
from compiled_folder import CompiledFolder
from wgsl_compile import OPTIONS, Shader, translate
from wgsl_small import with_references, without_references

from mua.errors import InputError
from mua.gpu import compile, packaged_spirv
from mua.gpu.reflect import BufferSlot, Constant, Interface

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT / "python" / "mua" / "web" / "wgsl"
HEADER = "// Generated from {} by tools/gen_wgsl.py; do not edit.\n"
OBJECT = """
/** @type {{import("../shader.js").Shader}} */
export const {entry} = {{
  ...{interface},
  code: {code},
}};
"""
IMPORTS = """
import {{ withLines }} from "../shader.js";
import {{ {entry} }} from "./{stem}.js";
"""
PARSED = re.compile(r"^export const (\w+) = \{\n  \.\.\.(\{.*\}),\n  code: (?:withLines\()?`([^`]*)`", re.MULTILINE)
LENDERS = {"expressions": ("inverse_dwt", "UpsampleTexels")}  # of modules that are loaded on demand


def sources() -> dict[str, str]:
    """The digest of what each module is to be made from."""
    texts: dict[str, list[str]] = {}
    for path, entry, stage in entry_points():
        files, options = compile.made_from(path, entry, stage)
        texts.setdefault(path.stem, []).append(packaged_spirv.digest(files.values(), options))
    for stem, (lender, _) in LENDERS.items():
        texts[stem] += texts[lender]
    return {f"{stem}.js": packaged_spirv.digest(digests, tuple(OPTIONS)) for stem, digests in texts.items()}


def modules() -> dict[str, bytes]:
    """Each module, translated now; raises InputError where slangc is absent or refuses."""
    shaders = {(path.stem, entry): translate(path, entry, stage) for path, entry, stage in entry_points()}
    found: dict[str, str] = {}
    for path, entry, _ in entry_points():
        lender = LENDERS.get(path.stem)
        imports = IMPORTS.format(stem=lender[0], entry=lender[1]) if lender else ""
        header = HEADER.format(path.relative_to(ROOT).as_posix()) + imports
        name = f"{path.stem}.js"
        written = as_object(shaders[path.stem, entry], shaders[lender] if lender else None)
        found[name] = found.get(name, header) + written
    return {name: text.encode() for name, text in found.items()}


def as_object(shader: Shader, lender: Shader | None) -> str:
    """The JavaScript of one entry point."""
    described = {"stage": shader.stage, "entry": shader.entry, **asdict(shader.interface)}
    if set("`$\\") & set(shader.code):
        raise InputError(f"{shader.entry}: the WGSL has a character that a template literal takes for its own")
    code = f"withLines(`{with_references(shader.code, lender.code)}`, {lender.entry})" if lender else f"`{shader.code}`"
    return OBJECT.format(entry=shader.entry, interface=json.dumps(described, separators=(",", ":")), code=code)


def read(folder: Path = FOLDER) -> dict[tuple[str, str], Shader]:
    """The committed shaders by stem and entry point."""
    found = {}
    for path in sorted(folder.glob("*.js")):
        for entry, written, code in PARSED.findall(path.read_text()):
            described = json.loads(written)
            found[path.stem, entry] = Shader(entry, described["stage"], code, interface_of(described))
    for (stem, entry), shader in found.items():
        if stem in LENDERS:
            code = without_references(shader.code, found[LENDERS[stem]].code)
            found[stem, entry] = replace(shader, code=code)
    return found


def interface_of(described: dict[str, Any]) -> Interface:
    constants = [{**c, "shape": tuple(c["shape"]), "strides": tuple(c["strides"])} for c in described["constants"]]
    return Interface(
        tuple(BufferSlot(**slot) for slot in described["buffers"]),
        tuple(Constant(**constant) for constant in constants),
        described["constants_binding"],
        tuple(described["threads"]),
    )


WGSL = CompiledFolder("gen_wgsl.py", FOLDER, ".js", "slang", sources, modules)

if __name__ == "__main__":
    WGSL.run(__doc__)
