"""Pack the browser player as the npm package @mua/player, with types that tsc writes from its comments.

Needs Node, npm and the packages of tests/web/package.json (npm ci --prefix tests/web). Nothing is published.
"""

import argparse
import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PLAYER, TESTS = ROOT / "python" / "mua" / "web", ROOT / "tests" / "web"
TSC = TESTS / "node_modules" / "typescript" / "bin" / "tsc"
# What querySelector("mua-avatar") finds, which no comment of JavaScript can say.
TAG = """
declare global {
  interface HTMLElementTagNameMap {
    "mua-avatar": MuaAvatar;
  }
}
"""
# The same for JSX of React 19.
REACT = """import type { DetailedHTMLProps, HTMLAttributes } from "react";
import type { MuaAvatar } from "./element.js";
import type { PROPERTIES } from "./properties.js";

export * from "./element.js";

interface Listeners {
  onload?: (event: CustomEvent) => void;
  onerror?: (event: CustomEvent<Error>) => void;
  onprogress?: (event: CustomEvent<{ totalProgress: number }>) => void;
  onpicture?: (event: Event) => void;
  onplay?: (event: CustomEvent<{ clip: string | null; time: number }>) => void;
  onpause?: (event: CustomEvent<{ clip: string | null; time: number }>) => void;
  onloop?: (event: CustomEvent<{ clip: string | null; time: number }>) => void;
  onend?: (event: CustomEvent<{ clip: string | null; time: number }>) => void;
}

declare module "react" {
  namespace JSX {
    interface IntrinsicElements {
      "mua-avatar": DetailedHTMLProps<HTMLAttributes<MuaAvatar>, MuaAvatar> &
        Partial<Pick<MuaAvatar, (typeof PROPERTIES)[number]>> &
        Listeners;
    }
  }
}
"""
ENTRIES = ("player.js", "element.js")  # the modules that users import


def lacking() -> str | None:
    """The program to install first; None where nothing is missing."""
    if shutil.which("npm") is None:
        return "needs Node and npm"
    if not TSC.is_file():
        return "needs the packages of tests/web/package.json: npm ci --prefix tests/web"
    return None


def write_types(folder: Path) -> None:
    """The types of a copy of the player, below `types`."""
    settings = json.loads((TESTS / "tsconfig.json").read_text())
    options = settings["compilerOptions"] | {"noEmit": False, "declaration": True, "emitDeclarationOnly": True}
    options |= {"outDir": "types", "rootDir": "."}
    known = [str(path) for path in TESTS.glob("*.d.ts")]  # types that lib.dom lacks
    written = folder / "tsconfig.json"
    written.write_text(json.dumps({"compilerOptions": options, "files": [*ENTRIES, "worker.js", *known]}))
    subprocess.run(["node", str(TSC), "-p", str(written)], check=True, stdout=sys.stderr)
    written.unlink()
    element = folder / "types" / "element.d.ts"
    element.write_text(element.read_text() + TAG)
    (folder / "types" / "react.d.ts").write_text(REACT)


def pack(output: Path) -> Path:
    """Write the package's tarball into a folder."""
    output.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch) / "player"
        shutil.copytree(PLAYER, folder)
        shutil.copyfile(ROOT / "LICENSE", folder / "LICENSE")
        write_types(folder)
        line = ["npm", "pack", "--json", "--pack-destination", str(output.resolve())]
        packed = subprocess.run(line, cwd=folder, check=True, capture_output=True, text=True)
    return output / json.loads(packed.stdout)[0]["filename"]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "build", help="folder for the tarball")
    options = parser.parse_args()
    if missing := lacking():
        sys.exit(f"error: {missing}")
    path = pack(options.output)
    print(f"{path}: {path.stat().st_size / 1000:.0f} KB")


if __name__ == "__main__":
    main()
