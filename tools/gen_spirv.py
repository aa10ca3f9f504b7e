"""Write python/mua/gpu/spirv, the SPIR-V of every kernel and draw; --check says whether it is up to date.

From which texts each file was made is always compared, which needs no compiler. The code is compared where this machine
has the compiler of the index, as another version of it may make other code.
"""

import argparse
import json
import sys
from pathlib import Path
from typing import Any

import checkout  # noqa: F401
import shader_compilers
from check_shaders import entry_points

from mua.errors import InputError
from mua.gpu import compile, compiled, glslang

ROOT = Path(__file__).resolve().parents[1]
ABOUT = "written by tools/gen_spirv.py"


def sources() -> dict[str, str]:
    """The digest of what each file is to be made from."""
    found = {}
    for path, entry, stage in entry_points():
        texts, options = compile.made_from(path, entry, stage)
        found[compiled.file_name(path, entry, stage)] = compiled.digest(texts.values(), options)
    return found


def codes() -> dict[str, bytes]:
    """The content of each file, compiled now."""
    found = {}
    for path, entry, stage in entry_points():
        _, options = compile.made_from(path, entry, stage)
        found[compiled.file_name(path, entry, stage)] = glslang.compile(path, options)
    return found


def faults(folder: Path) -> list[str]:
    """Files of the folder that are out of date, a line each."""
    index, wanted = read_index(folder), sources()
    made_from, there = index["made from"], {path.name for path in folder.glob("*.spv")}
    found = [f"{name} was made from another text" for name in wanted if made_from.get(name) != wanted[name]]
    found += [f"{name} is missing" for name in sorted(wanted.keys() - there)]
    found += [f"{name} belongs to no entry point" for name in sorted((there | made_from.keys()) - wanted.keys())]
    if found or signature() != index["compiler"]:
        return found
    made = codes().items()
    return [f"{name} is not what the compiler makes" for name, code in made if (folder / name).read_bytes() != code]


def read_index(folder: Path) -> dict[str, Any]:
    content: dict[str, Any] = json.loads((folder / compiled.INDEX).read_text())
    return content


def signature() -> str:
    """Name and version of the compiler of this machine."""
    compiler = shader_compilers.find("glslang")
    return "no compiler" if compiler is None else f"{compiler.name} {compiler.version}"


def write(folder: Path) -> None:
    """Compile everything; raises InputError where the compiler is absent or refuses."""
    made = codes()
    folder.mkdir(exist_ok=True)
    for path in folder.glob("*.spv"):
        if path.name not in made:
            path.unlink()
    for name, code in made.items():
        (folder / name).write_bytes(code)
    index = {"about": ABOUT, "compiler": signature(), "made from": sources()}
    (folder / compiled.INDEX).write_text(json.dumps(index, indent=1) + "\n")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="exit 1 where a committed file differs")
    if not parser.parse_args().check:
        try:
            write(compiled.FOLDER)
        except InputError as error:
            sys.exit(f"error: {error}")
        return
    if wrong := faults(compiled.FOLDER):
        sys.exit("\n".join([*wrong, f"{compiled.FOLDER.relative_to(ROOT)} is out of date: run tools/gen_spirv.py"]))
    here, made_by = signature(), read_index(compiled.FOLDER)["compiler"]
    if here != made_by:
        print(f"compiled code was not compared: it is of {made_by}, this machine has {here}")


if __name__ == "__main__":
    main()
