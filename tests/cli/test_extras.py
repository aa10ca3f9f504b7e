"""Who only looks installs little: each command's extra brings all that the command may import, and no other does."""

import ast
import json
import re
import sys
import tomllib
from functools import cache
from pathlib import Path

import pytest
from bare_python import run_bare
from commands import Ended
from PIL import Image

import mua
from mua import extras
from mua.extras import EXTRAS, OF_COMMAND, missing_package

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = Path(mua.__file__).parent
PROJECT = tomllib.loads((ROOT / "python" / "pyproject.toml").read_text())["project"]
COMMANDS = [name.removeprefix("mua-") for name in PROJECT["scripts"]]
CALLED = {"PIL": "pillow", "pxr": "usd-core", "pywt": "pywavelets", "warp": "warp-lang"}  # distributions of packages
FEW_USE = {  # by extra: USD files; videos of captures, a perceptual term, a rasteriser for CUDA; other systems
    "view": {"pxr"},
    "eval": {"pxr", "gsplat", "mua-research"},
    "bake": {"imageio_ffmpeg", "torchmetrics", "gsplat"},
    "teach": {"gsplat"},
}


def test_the_wheel_carries_the_whole_browser_player() -> None:
    data = tomllib.loads((ROOT / "python" / "pyproject.toml").read_text())["tool"]["setuptools"]["package-data"]["mua"]
    carried = {path for pattern in data for path in PACKAGE.glob(pattern)}
    files = {path for path in (PACKAGE / "web").rglob("*") if path.is_file()}
    assert len(files) > 40
    assert files <= carried


def normal(requirement: str) -> str:
    """The name of a distribution without version and spelling."""
    return re.split(r"[<>=,\[; ]", requirement)[0].lower().replace("_", "-")


def brought(extra: str) -> set[str]:
    """The distributions of an extra and of those that it includes."""
    found: set[str] = set()
    for requirement in PROJECT["optional-dependencies"][extra]:
        included = re.fullmatch(r"mua\[(.*)\]", requirement)
        found |= set().union(*map(brought, included[1].split(","))) if included else {normal(requirement)}
    return found


BASE = {normal(requirement) for requirement in PROJECT["dependencies"]}


def distribution(package: str) -> str:
    return CALLED.get(package, normal(package))


@cache
def imports(path: Path) -> frozenset[str]:
    """All modules that a file imports when it runs, at any depth of its code."""
    found = set()
    waiting: list[ast.AST] = [ast.parse(path.read_text())]
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING":
            continue
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            found |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
        waiting += ast.iter_child_nodes(node)
    return frozenset(found)


def files(module: str) -> list[Path]:
    """The files that importing a module of the package runs."""
    path = PACKAGE.parent.joinpath(*module.split("."))
    parents = [parent / "__init__.py" for parent in path.parents if parent.is_relative_to(PACKAGE)]
    return [file for file in (path.with_suffix(".py"), path / "__init__.py", *parents) if file.is_file()]


def reached(module: str) -> set[str]:
    """The distributions that a module may import, directly or through others of the package."""
    seen: set[Path] = set()
    waiting, foreign = files(module), set()
    while waiting:
        file = waiting.pop()
        if file in seen:
            continue
        seen.add(file)
        for name in imports(file):
            if name.partition(".")[0] == "mua":
                waiting += files(name)
            else:
                foreign.add(name.partition(".")[0])
    return {distribution(name) for name in foreign - set(sys.stdlib_module_names)}


@pytest.mark.parametrize("extra", EXTRAS)
def test_the_sentences_know_what_each_extra_brings(extra: str) -> None:
    assert {distribution(package) for package in EXTRAS[extra]} == brought(extra)


@pytest.mark.parametrize("name", COMMANDS)
def test_a_commands_extra_brings_all_that_it_may_import(name: str) -> None:
    extra = OF_COMMAND.get(f"mua-{name}", name)
    few = {distribution(package) for package in FEW_USE.get(extra, set())}
    assert reached(f"mua.cli.{name}") - BASE <= (brought(extra) if extra in EXTRAS else set()) | few


def test_reading_and_picturing_on_the_cpu_need_no_extra() -> None:
    modules = "mua.asset, mua.avatar.decode, mua.avatar.rendering, mua.cli.inspect, mua.cli.pack"
    assert run_bare(f"import {modules}") == Ended(0, "", "")


def test_a_picture_by_the_cpu_needs_no_extra(avatar_file: Path, tmp_path: Path) -> None:
    picture = tmp_path / "a.png"
    code = "sys.argv[0] = 'mua-view'\nfrom mua.cli.view import run\nrun()"
    ended = run_bare(code, avatar_file, "--reference", "--size", "32", "-o", picture)
    assert (ended.status, ended.err) == (0, "")
    with Image.open(picture) as image:
        assert image.size == (32, 32)


RUN = """
import contextlib, importlib, io, json
answers = {}
for name, given in json.loads(sys.argv[1]).items():
    sys.argv[:] = [f"mua-{name}", *given]
    with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(io.StringIO()) as err:
        try:
            importlib.import_module(f"mua.cli.{name}").run()
        except SystemExit as ended:
            answers[name] = ended.code, out.getvalue(), err.getvalue()
print(json.dumps(answers))
"""


def test_a_missing_extra_is_told_with_the_command_that_brings_it(
    written: Path, avatar_file: Path, tmp_path: Path
) -> None:
    (tmp_path / "capture.json").touch()
    given: dict[str, tuple[str | Path, ...]] = dict.fromkeys(set(COMMANDS) - {"inspect", "pack"}, (avatar_file,))
    given |= {"bake": (), "eval": (written,), "train": (written,), "view": (avatar_file, "-o", "a.png")}
    given |= {"export": (avatar_file, "-o", "a.glb"), "share": (avatar_file, "-o", "shared")}
    given |= {"capture": ("check", tmp_path), "teach": (tmp_path,)}
    ended = run_bare(RUN, json.dumps(given, default=str))
    assert ended.err == ""
    answers = {name: Ended(*answer) for name, answer in json.loads(ended.out).items()}
    assert set(answers) == set(given)
    for name, answer in answers.items():
        matched = re.fullmatch(
            r"error: mua-(\w+) needs the Python package (\w+), which is not here: "
            rf'{re.escape(sys.executable)} -m pip install -e "{PACKAGE.parent}\[(\w+)\]"',
            answer.sentence,
        )
        assert matched, answer
        assert answer.out == ""
        assert (matched[1], matched[3]) == (name, OF_COMMAND.get(f"mua-{name}", name))
        assert matched[2] in EXTRAS[matched[3]]


def test_a_function_that_lacks_an_extra_names_it(written: Path) -> None:
    calls = {"mua.bake()": "bake", "mua.train(sys.argv[1])": "train", "mua.Recording(sys.argv[1])": "train"}
    calls |= {"mua.TeacherWriter": "train", "mua.load_rig('hero.glb')": "bake"}
    code = "".join(f"try:\n    {call}\nexcept ModuleNotFoundError as error:\n    print(error)\n" for call in calls)
    lines = run_bare(f"import mua\n{code}", written).out.splitlines()
    for line, (call, extra) in zip(lines, calls.items(), strict=True):
        named = call.partition("(")[0]
        assert re.fullmatch(rf'{named} needs the Python package \w+, which is not here: .*\[{extra}\]"', line)


def test_a_command_that_few_ask_more_of_names_both_extras(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(extras, "__file__", str(tmp_path / "mua" / "extras.py"))  # as a wheel is installed
    assert missing_package("mua-view", "pxr.Usd") == (
        'mua-view needs the Python package pxr, which is not here: pip install "mua[view,export]"'
    )


def test_a_module_that_no_extra_brings_is_left_to_its_traceback() -> None:
    assert missing_package("mua-view", "mua.playr") is None


def test_the_licence_is_that_of_the_repository() -> None:
    assert (ROOT / "python" / "LICENSE").read_bytes() == (ROOT / "LICENSE").read_bytes()
