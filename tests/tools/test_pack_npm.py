"""The npm package: its version is the project's, it has all modules, and a TypeScript program can use its types."""

import json
import subprocess
import tarfile
from pathlib import Path

import pack_npm
import pytest

import mua
from mua.share.site import PLAYER, player_files

USE = """
import { createPlayer, type AvatarHandle, type Follow, type PlayedClip } from "@mua/player";
import { MuaAvatar } from "@mua/player/element.js";
export async function begin(canvas: HTMLCanvasElement): Promise<string[]> {
  const player = await createPlayer(canvas);
  const handle: AvatarHandle = await player.load("hero.muaavatar", { onProgress: (share: number) => void share });
  player.camera.azimuth = 1;
  return handle.clips.map(({ name }) => name);
}
export async function pose(handle: AvatarHandle, element: MuaAvatar): Promise<string> {
  const { names, parents, rotations } = handle.skeleton;
  handle.setPose({ rotations, translations: { [names[0]]: [0, 1, 0] } });
  handle.setExpressions({ [handle.expressions[0]]: 1 });
  const follow: Follow = await handle.retarget({ names, parents, rotations, positions: [] }, { mapping: {} });
  element.setPose(follow(rotations, new Float32Array(3)));
  const played: PlayedClip | null = await element.playClip(new Blob([]), { loop: false, name: "wave" });
  return played?.notes.join() ?? "";
}
const found = document.querySelector("mua-avatar");
if (found) [found.src, found.clip, found.speed, found.controls] = ["hero.muaavatar", "wave", 0.5, true];
export const made: MuaAvatar = document.createElement("mua-avatar");
export const shown = (element: MuaAvatar): number => element.avatars.length;
"""
IN_REACT = """
import { useRef } from "react";
import type { MuaAvatar } from "@mua/player/react";
export const Hero = ({ clip }: { clip?: string }) => {
  const element = useRef<MuaAvatar>(null);
  const said = ({ detail }: CustomEvent<Error>) => alert(detail.message);
  const ended = ({ detail }: CustomEvent<{ clip: string | null; time: number }>) => alert(detail.clip);
  const told = { onerror: said, onend: ended };
  return <mua-avatar ref={element} src="hero.muaavatar" clip={clip} speed={0.5} controls {...told} />;
};
"""
WRONG = """import { createPlayer } from "@mua/player";
export const wrong: Promise<number> = createPlayer(1);
export const device: GPUDevice | null = null;
"""


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder in which the package is installed, where TypeScript does not know WebGPU, as version 5.9."""
    if missing := pack_npm.lacking():
        pytest.skip(missing)
    folder = tmp_path_factory.mktemp("npm")
    with tarfile.open(pack_npm.pack(folder)) as packed:
        packed.extractall(folder / "unpacked", filter="data")
    (folder / "node_modules" / "@mua").mkdir(parents=True)
    dom = folder / "node_modules" / "@typescript" / "lib-dom" / "index.d.ts"  # replaces the compiler's own
    dom.parent.mkdir(parents=True)
    dom.write_text(next(pack_npm.TESTS.glob("node_modules/**/lib.dom.d.ts")).read_text().replace("GPU", "Other"))
    (folder / "unpacked" / "package").rename(folder / "node_modules" / "@mua" / "player")
    return folder


def compiled(folder: Path, program: str, name: str = "use.ts") -> str:
    """tsc's output for a program beside the installed package."""
    (folder / name).write_text(program)
    line = ["node", str(pack_npm.TSC), "--noEmit", "--strict", "--libReplacement", "--module", "ES2022"]
    line += [
        "--moduleResolution",
        "bundler",
        "--target",
        "ES2024",
        "--lib",
        "ES2024,DOM,DOM.Iterable",
        "--jsx",
        "react-jsx",
        name,
    ]
    return subprocess.run(line, cwd=folder, capture_output=True, text=True, check=False).stdout


def test_its_version_is_that_of_the_project() -> None:
    assert json.loads((PLAYER / "package.json").read_text())["version"] == mua.__version__


def test_it_holds_every_module_and_no_settings(installed: Path) -> None:
    package = installed / "node_modules" / "@mua" / "player"
    held = {path.relative_to(package).as_posix() for path in package.rglob("*") if path.is_file()}
    assert set(player_files()) | {"index.html", "package.json", "LICENSE", "README.md"} <= held
    assert {path.split(".", 1)[1] for path in held if path.startswith("types/")} == {"d.ts"}
    assert "tsconfig.json" not in held


def test_its_entries_are_there(installed: Path) -> None:
    package = installed / "node_modules" / "@mua" / "player"
    given = json.loads((package / "package.json").read_text())
    entries = given["exports"]
    assert "." in entries
    assert (package / entries.pop("./worker.js")).is_file()  # for bundlers, which look for it by this name
    for name, entry in entries.items():
        assert (package / entry["types"]).is_file()
        assert (package / entry["default"]).is_file()
        if name != ".":  # where TypeScript reads no exports, as in what Next.js 15 sets up
            assert given["typesVersions"]["*"][name.removeprefix("./")] == [entry["types"]]


def test_a_program_can_use_its_types(installed: Path) -> None:
    assert compiled(installed, USE) == ""


def test_react_knows_the_element_and_its_properties(installed: Path) -> None:
    types = installed / "node_modules" / "@types"
    if not types.exists():
        types.symlink_to(pack_npm.TESTS / "node_modules" / "@types")
        (installed / "node_modules" / "csstype").symlink_to(pack_npm.TESTS / "node_modules" / "csstype")
    assert compiled(installed, IN_REACT, "use.tsx") == ""
    wrong = IN_REACT.replace("speed={0.5}", 'speed="fast"')
    assert "Type 'string' is not assignable to type 'number" in compiled(installed, wrong, "use.tsx")


def test_its_types_find_a_mistake(installed: Path) -> None:
    said = compiled(installed, WRONG)
    assert "use.ts(2,14)" in said
    assert "use.ts(3,22)" in said


def test_importing_the_element_needs_no_browser(installed: Path) -> None:
    code = "import('@mua/player/element.js').then(({ MuaAvatar }) => console.log(typeof MuaAvatar))"
    ran = subprocess.run(["node", "-e", code], cwd=installed, capture_output=True, text=True, check=False)
    assert (ran.stdout, ran.stderr) == ("function\n", "")


def test_the_players_comments_are_types_that_hold() -> None:
    if missing := pack_npm.lacking():
        pytest.skip(missing)
    line = ["node", str(pack_npm.TSC), "-p", str(pack_npm.TESTS / "tsconfig.json")]
    assert subprocess.run(line, capture_output=True, text=True, check=False).stdout == ""
