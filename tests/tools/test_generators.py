"""Tools that write files of the repository: they write what is stale, and --check names it and changes nothing."""

import os
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import checkout
import compiled_folder
import gen_expression_names
import gen_joint_words
import gen_kernel_table
import gen_meta
import gen_spirv
import gen_wgsl
import generated
import pytest
from compiled_folder import CompiledFolder

from mua.errors import InputError


def test_what_is_stale_is_named_and_then_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    right, stale, absent = (tmp_path / name for name in ("right.js", "stale.js", "absent.bin"))
    contents: dict[Path, str | bytes] = {right: "é", stale: "new", absent: b"\0"}
    right.write_bytes("é".encode())
    stale.write_text("old")
    monkeypatch.setattr("sys.argv", ["tool", "--check"])
    with pytest.raises(SystemExit, match=r"stale\.js is out of date: run tools/gen\.py"):
        generated.run("gen.py", "About.", contents)
    assert stale.read_text() == "old"
    monkeypatch.setattr("sys.argv", ["tool"])
    generated.run("gen.py", "About.", contents)
    assert [path.read_bytes() for path in contents] == ["é".encode(), b"new", b"\0"]
    monkeypatch.setattr("sys.argv", ["tool", "--check"])
    generated.run("gen.py", "About.", contents)


def test_what_the_tools_write_stands_in_the_checkout() -> None:
    tables = {gen_kernel_table.README: gen_kernel_table.generate()}
    for path, text in (gen_expression_names.contents() | gen_joint_words.contents() | tables).items():
        assert path.read_text(encoding="utf-8") == text


def test_metas_that_are_stale_are_named_and_then_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "package.json").write_text('{"name": "com.mua.test"}')
    monkeypatch.setattr(gen_meta, "PACKAGES", [tmp_path / "nowhere", tmp_path])
    monkeypatch.setattr("sys.argv", ["tool", "--check"])
    with pytest.raises(SystemExit, match=r"package\.json\.meta is (?s:.*)run tools/gen_meta\.py"):
        gen_meta.main()
    assert not (tmp_path / "package.json.meta").exists()
    monkeypatch.setattr("sys.argv", ["tool"])
    gen_meta.main()
    assert (tmp_path / "package.json.meta").is_file()


@pytest.fixture(params=[gen_spirv.SPIRV, gen_wgsl.WGSL], ids=["spirv", "wgsl"])
def compiles(request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> CompiledFolder:
    """A folder that a tool compiles, with an entry point of its own."""
    folder, ending = tmp_path / "compiled", request.param.ending
    folder.mkdir()
    (folder / f"old{ending}").touch()
    monkeypatch.setattr("sys.argv", ["tool"])
    monkeypatch.setattr(compiled_folder, "signature", lambda _: "one 1.0")
    made = {"contents": lambda: {f"new{ending}": b"code"}, "sources": lambda: {f"new{ending}": "a digest"}}
    return replace(request.param, path=folder, **made)


def test_compiled_shaders_are_written_once_they_are_asked_for(
    compiles: CompiledFolder, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    compiles.run("About.")
    assert {path.stem for path in compiles.path.iterdir() if path.suffix != ".json"} == {"new"}
    monkeypatch.setattr("sys.argv", ["tool", "--check"])
    compiles.run("About.")
    assert capsys.readouterr().out == ""
    monkeypatch.setattr(compiled_folder, "signature", lambda _: "no compiler")
    compiles.run("About.")
    assert capsys.readouterr().out.endswith("it is of one 1.0, this machine has no compiler\n")
    next(path for path in compiles.path.iterdir() if path.stem == "new").unlink()
    with pytest.raises(SystemExit, match=rf"^new.* is missing\n.*compiled is out of date: run tools/{compiles.tool}"):
        compiles.run("About.")


def test_a_compiler_that_refuses_ends_in_its_sentence(compiles: CompiledFolder) -> None:
    def refuse() -> dict[str, bytes]:
        raise InputError("there is no compiler")

    with pytest.raises(SystemExit, match="error: there is no compiler"):
        replace(compiles, contents=refuse).run("About.")


def test_a_generator_takes_the_package_of_its_own_checkout(tmp_path: Path) -> None:
    for folder in ("tools", "python/mua", "elsewhere/mua"):
        (tmp_path / folder).mkdir(parents=True)
        (tmp_path / folder / "__init__.py").touch()
    shutil.copy(checkout.__file__, tmp_path / "tools")
    program = tmp_path / "tools" / "generator.py"
    program.write_text("import checkout\nimport mua\nprint(mua.__file__)\n")
    installed = os.environ | {"PYTHONPATH": str(tmp_path / "elsewhere")}
    ran = subprocess.run([sys.executable, program], env=installed, capture_output=True, text=True, check=True)
    assert ran.stdout.strip() == str(tmp_path / "python" / "mua" / "__init__.py")
