"""tools/check_shaders.py: the faults it finds and its exit status."""

import subprocess
from pathlib import Path

import check_shaders
import pytest
from check_shaders import KERNELS, messages
from shader_compilers import Compiler

KERNEL = KERNELS / "mlp_matmul.compute"


@pytest.fixture
def compiler() -> Compiler:
    return Compiler("one", "1.0", lambda *_: [])


@pytest.mark.parametrize(
    ("printed", "status", "found"),
    [
        ("", 0, []),
        ("compiled\n", 0, []),
        ("a.compute:3: warning: unused\n", 0, ["a.compute:3: warning: unused"]),
        ("  error X3000: no\nsee above\n", 1, ["error X3000: no"]),
        ("warning X3568: 'kernel' : unknown pragma ignored\n", 0, []),
        ("killed\nmore\n", 9, ["status 9", "killed"]),
        ("", 9, ["status 9"]),
    ],
)
def test_every_warning_and_every_failure_counts_but_unitys_pragma(
    monkeypatch: pytest.MonkeyPatch, compiler: Compiler, printed: str, status: int, found: list[str]
) -> None:
    done = subprocess.CompletedProcess([], status, stdout=printed, stderr="")
    monkeypatch.setattr("shader_compilers.run_compiler", lambda *_: done)
    assert messages(compiler, KERNEL, "MlpMatmul", "comp") == found


@pytest.mark.parametrize(
    ("lines", "broken", "there", "status"),
    [([], [], True, 0), (["warning: x"], [], True, 1), ([], ["a rule"], True, 1), ([], [], False, 1)],
)
def test_ends_with_1_where_anything_is_wrong(
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    compiler: Compiler,
    lines: list[str],
    broken: list[str],
    there: bool,
    status: int,
) -> None:
    monkeypatch.setattr("shader_compilers.FINDERS", {compiler.name: None, "another": None})
    monkeypatch.setattr("shader_compilers.INSTALL", {compiler.name: "a package", "another": "a package of its own"})
    monkeypatch.setattr("shader_compilers.find", lambda name: compiler if there and name == compiler.name else None)
    monkeypatch.setattr(check_shaders, "messages", lambda *_: lines)
    monkeypatch.setattr(check_shaders, "rule_faults", lambda: broken)
    monkeypatch.setattr(check_shaders, "entry_points", lambda: [(Path("a.compute"), "Main", "comp")])
    monkeypatch.setenv("COLUMNS", "200")
    with pytest.raises(SystemExit) as ended:
        check_shaders.main()
    printed = capsys.readouterr().out
    assert ended.value.code == status
    assert "another is not on this machine; it comes with a package of its own" in printed
    assert all(f"a.compute: Main: {compiler.name}: {line}" in printed for line in lines)
    assert all(line in printed for line in broken)
    assert ("ok" in printed) == (there and not lines)
