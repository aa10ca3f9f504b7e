"""Tools that write files of the repository: they write what is stale, and --check names it and changes nothing."""

from pathlib import Path
from types import ModuleType

import gen_golden
import gen_kernel_table
import gen_meta
import gen_spirv
import pytest


@pytest.fixture
def stale(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest) -> tuple[ModuleType, Path]:
    """A tool, and a file in which something else stands than it writes."""
    module = request.param
    monkeypatch.setattr("sys.argv", [f"{module.__name__}.py"])
    if module is gen_golden:
        written = tmp_path / "golden.bin"
        monkeypatch.setattr(module, "generate", lambda: {written: b"generated"})
        monkeypatch.setattr(module, "ROOT", tmp_path)
    elif module is gen_kernel_table:
        written = tmp_path / "README.md"
        before = module.README.read_text()
        written.write_text(before)
        monkeypatch.setattr(module, "README", written)
        monkeypatch.setattr(module, "ROOT", tmp_path)
        assert module.generate() == before  # of this checkout
        written.write_text(before.replace("| 256 |", "| 255 |"))
    else:
        written = tmp_path / "package.json.meta"
        (tmp_path / "package.json").write_text('{"name": "com.mua.test"}')
        monkeypatch.setattr(module, "PACKAGES", [tmp_path / "nowhere", tmp_path])
    return module, written


@pytest.mark.parametrize("stale", [gen_golden, gen_kernel_table, gen_meta], indirect=True)
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


def test_a_compiler_that_is_not_that_of_the_index_is_told(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sys.argv", ["gen_spirv.py", "--check"])
    monkeypatch.setattr(gen_spirv, "faults", lambda _: ["a.spv is missing"])
    with pytest.raises(SystemExit, match=r"a.spv is missing\n.*spirv is out of date: run tools/gen_spirv.py"):
        gen_spirv.main()
    monkeypatch.setattr(gen_spirv, "faults", lambda _: [])
    made_by = gen_spirv.read_index(gen_spirv.compiled.FOLDER)["compiler"]
    for here, told in ((made_by, ""), ("no compiler", f"it is of {made_by}, this machine has no compiler\n")):
        monkeypatch.setattr(gen_spirv, "signature", lambda here=here: here)
        gen_spirv.main()
        assert capsys.readouterr().out.endswith(told)
        assert not capsys.readouterr().out
