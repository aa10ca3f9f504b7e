"""Tools that write files of the repository: they write what is stale, and --check names it and changes nothing."""

import os
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from types import ModuleType

import checkout
import compiled_folder
import gen_expression_names
import gen_golden
import gen_joint_words
import gen_kernel_table
import gen_meta
import gen_spirv
import gen_wgsl
import pytest
from compiled_folder import CompiledFolder

from mua.errors import InputError


@pytest.fixture
def stale(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest) -> tuple[ModuleType, Path]:
    """A tool, and a file in which something else stands than it writes."""
    module = request.param
    monkeypatch.setattr("sys.argv", [f"{module.__name__}.py"])
    if module is gen_golden:
        written = tmp_path / "golden.bin"
        monkeypatch.setattr(module, "generate", lambda: {written: b"generated"})
        monkeypatch.setattr(module, "ROOT", tmp_path)
    elif module is gen_expression_names:
        written = tmp_path / "table.js"
        before = module.MODULE.read_text(encoding="utf-8")
        written.write_text(before.replace("jawOpen", "jaw"), encoding="utf-8")
        monkeypatch.setattr(module, "MODULE", written)
        assert (module.module(), module.script()) == (before, module.CLASS.read_text(encoding="utf-8"))
        monkeypatch.setattr(module, "CLASS", tmp_path / "Table.cs")
        (tmp_path / "Table.cs").write_text(module.script(), encoding="utf-8")
        monkeypatch.setattr(module, "ROOT", tmp_path)
    elif module is gen_joint_words:
        written = tmp_path / "joint_words.js"
        for path, text in module.generate().items():
            assert path.read_text(encoding="utf-8") == text  # the checkout's own
        written.write_text("stale", encoding="utf-8")
        monkeypatch.setattr(module, "generate", lambda: {written: "generated"})
        monkeypatch.setattr(module, "ROOT", tmp_path)
    elif module is gen_kernel_table:
        written = tmp_path / "README.md"
        before = module.README.read_text()
        written.write_text(before)
        monkeypatch.setattr(module, "README", written)
        monkeypatch.setattr(module, "ROOT", tmp_path)
        assert module.generate() == before  # the checkout's own
        written.write_text(before.replace("| 256 |", "| 255 |"))
    else:
        written = tmp_path / "package.json.meta"
        (tmp_path / "package.json").write_text('{"name": "com.mua.test"}')
        monkeypatch.setattr(module, "PACKAGES", [tmp_path / "nowhere", tmp_path])
    return module, written


@pytest.mark.parametrize(
    "stale", [gen_expression_names, gen_golden, gen_joint_words, gen_kernel_table, gen_meta], indirect=True
)
def test_what_is_stale_is_named_and_then_written(
    stale: tuple[ModuleType, Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    module, path = stale
    before = path.read_bytes() if path.is_file() else None
    with monkeypatch.context() as checking:
        checking.setattr("sys.argv", ["tool", "--check"])
        with pytest.raises(SystemExit, match=rf"{path.name} is (?s:.*)run tools/{module.__name__}\.py"):
            module.main()
        assert (path.read_bytes() if path.is_file() else None) == before
        with monkeypatch.context() as writing:
            writing.setattr("sys.argv", ["tool"])
            module.main()
        assert path.read_bytes() != before
        module.main()


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
