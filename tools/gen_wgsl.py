"""Write python/mua/web/wgsl, every kernel and draw for browsers; --check says whether it is up to date.

A file of ComputeShaders or of the desktop player becomes an ES module with an object for each entry point: its WGSL,
and what it binds by name. From which texts each was made is always compared, which needs no compiler. The code is
compared where this machine has the compiler of the index, as another version of it may make other code.
"""

import argparse
import json
import re
import sys
from dataclasses import asdict
from pathlib import Path
from typing import Any

import checkout  # noqa: F401
import shader_compilers
from check_shaders import entry_points
from wgsl_compile import OPTIONS, Shader, translate

from mua.errors import InputError
from mua.gpu import compile, compiled
from mua.gpu.reflect import BufferSlot, Constant, Interface

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT / "python" / "mua" / "web" / "wgsl"
INDEX = "index.json"
ABOUT = "written by tools/gen_wgsl.py"
HEADER = "// Generated from {} by tools/gen_wgsl.py; do not edit.\n"
OBJECT = """
/** @type {{import("../shader.js").Shader}} */
export const {entry} = {{
  ...{interface},
  code: `{code}`,
}};
"""
PARSED = re.compile(r"^export const (\w+) = \{\n  \.\.\.(\{.*\}),\n  code: `([^`]*)`,\n\};", re.MULTILINE)


def sources() -> dict[str, str]:
    """The digest of what each module is to be made from."""
    texts: dict[str, list[str]] = {}
    for path, entry, stage in entry_points():
        files, options = compile.made_from(path, entry, stage)
        texts.setdefault(path.stem, []).append(compiled.digest(files.values(), options))
    return {f"{stem}.js": compiled.digest(digests, tuple(OPTIONS)) for stem, digests in texts.items()}


def modules() -> dict[str, str]:
    """The text of each module, translated now; raises InputError where slangc is absent or refuses."""
    found: dict[str, str] = {}
    for path, entry, stage in entry_points():
        header = HEADER.format(path.relative_to(ROOT).as_posix())
        name = f"{path.stem}.js"
        found[name] = found.get(name, header) + as_object(translate(path, entry, stage))
    return found


def as_object(shader: Shader) -> str:
    """The JavaScript of one entry point."""
    interface = json.dumps({"stage": shader.stage, "entry": shader.entry, **asdict(shader.interface)})
    if set("`$\\") & set(shader.code):
        raise InputError(f"{shader.entry}: the WGSL has a character that a template literal takes for its own")
    return OBJECT.format(entry=shader.entry, interface=interface, code=shader.code)


def read(folder: Path = FOLDER) -> dict[tuple[str, str], Shader]:
    """The committed shaders by stem and entry point."""
    found = {}
    for path in sorted(folder.glob("*.js")):
        for entry, written, code in PARSED.findall(path.read_text()):
            described = json.loads(written)
            found[path.stem, entry] = Shader(entry, described["stage"], code, interface_of(described))
    return found


def interface_of(described: dict[str, Any]) -> Interface:
    constants = [{**c, "shape": tuple(c["shape"]), "strides": tuple(c["strides"])} for c in described["constants"]]
    return Interface(
        tuple(BufferSlot(**slot) for slot in described["buffers"]),
        tuple(Constant(**constant) for constant in constants),
        described["constants_binding"],
        tuple(described["threads"]),
    )


def faults(folder: Path) -> list[str]:
    """Files of the folder that are out of date, a line each."""
    index, wanted = read_index(folder), sources()
    made_from, there = index["made from"], {path.name for path in folder.glob("*.js")}
    found = [f"{name} was made from another text" for name in wanted if made_from.get(name) != wanted[name]]
    found += [f"{name} is missing" for name in sorted(wanted.keys() - there)]
    found += [f"{name} belongs to no shader" for name in sorted((there | made_from.keys()) - wanted.keys())]
    if found or signature() != index["compiler"]:
        return found
    made = modules().items()
    return [f"{name} is not what the compiler makes" for name, text in made if (folder / name).read_text() != text]


def read_index(folder: Path) -> dict[str, Any]:
    content: dict[str, Any] = json.loads((folder / INDEX).read_text())
    return content


def signature() -> str:
    """Name and version of the compiler of this machine."""
    compiler = shader_compilers.find("slang")
    return "no compiler" if compiler is None else f"{compiler.name} {compiler.version}"


def write(folder: Path) -> None:
    """Translate everything; raises InputError where the compiler is absent or refuses."""
    made = modules()
    folder.mkdir(exist_ok=True)
    for path in folder.glob("*.js"):
        if path.name not in made:
            path.unlink()
    for name, text in made.items():
        (folder / name).write_text(text)
    index = {"about": ABOUT, "compiler": signature(), "made from": sources()}
    (folder / INDEX).write_text(json.dumps(index, indent=1) + "\n")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="exit 1 where a committed file differs")
    if not parser.parse_args().check:
        try:
            write(FOLDER)
        except InputError as error:
            sys.exit(f"error: {error}")
        return
    if wrong := faults(FOLDER):
        sys.exit("\n".join([*wrong, f"{FOLDER.relative_to(ROOT)} is out of date: run tools/gen_wgsl.py"]))
    here, made_by = signature(), read_index(FOLDER)["compiler"]
    if here != made_by:
        print(f"translated code was not compared: it is of {made_by}, this machine has {here}")


if __name__ == "__main__":
    main()
