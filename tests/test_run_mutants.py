"""A run over a small tree: what tests catch, what survives, what is known as no fault."""

import subprocess
from pathlib import Path

import mutant_tests
import pytest
import run_mutants
from mutant_sites import Mutant, mutants
from mutant_tests import Checkout, Seen, record, seeing
from run_mutants import CAUGHT, EQUAL, SURVIVED, TIMED_OUT, UNCOMPILED, Outcome, drawn, reason, run, table

CODE = "def larger(a, b):\n    return a > b\n\ndef unseen(a):\n    return a + 1\n\ndef halved(a):\n    return a / 2\n"
TEST = (
    "from code_ import halved, larger\n\ndef test_it():\n    assert larger(2, 1) and not larger(1, 1)\n    halved(4)\n"
)


@pytest.fixture
def tree(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A repository with one module and one test of it."""
    root = tmp_path / "tree"
    (root / "python").mkdir(parents=True)
    (root / "tests").mkdir()
    (root / "python" / "code_.py").write_text(CODE)
    (root / "tests" / "test_code_.py").write_text(TEST)
    (root / "equivalent.toml").write_text(
        '[[equivalent]]\nfile = "python/*"\noperator = "constant"\nline = "return a / 2"\nreason = "nobody halves"\n'
    )
    subprocess.run(["git", "init", "-q", root], check=True)
    monkeypatch.setattr(run_mutants, "ROOT", root)
    monkeypatch.setattr(run_mutants, "EQUIVALENT", root / "equivalent.toml")
    monkeypatch.setattr(run_mutants, "LANGUAGES", {"python": ("python/*.py",)})
    return root


def test_each_fault_ends_as_caught_survived_or_equivalent(tree: Path, tmp_path: Path) -> None:
    checkout = Checkout(tmp_path / "job")
    checkout.refresh(tree)
    seen = record([checkout], tmp_path / "seen.json")
    assert seen["tests/test_code_.py"].functions["python/code_.py"] == ["<module>", "halved", "larger"]
    found = {
        each.mutant.lines(CODE)[2]: each
        for each in run(iter(mutants(tree / "python/code_.py", tree)), 9, [checkout], seen)
    }
    assert {line: each.result for line, each in found.items()} == {
        "return a >= b": CAUGHT,
        "return a - 1": SURVIVED,
        "return a + 2": SURVIVED,
        "return a * 2": SURVIVED,
        "return a / 3": EQUAL,
    }
    assert found["return a >= b"].by == "tests/test_code_.py::test_it"
    assert found["return a / 3"].by == "nobody halves"
    assert (checkout.root / "python" / "code_.py").read_text() == CODE


def test_the_command_prints_every_survivor_and_the_share(
    tree: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(run_mutants, "WORK", tmp_path / "work")
    monkeypatch.setattr("sys.argv", ["run_mutants.py", "--number", "9", "--seed", "4", "--jobs", "2"])
    run_mutants.main()
    printed = capsys.readouterr().out
    summary = printed[printed.index("faults") :].splitlines()
    caught, meant = (printed.count(f"\n{word} ") for word in (CAUGHT, SURVIVED))
    assert summary[1].split()[:3] == ["python", str(caught + meant // 2), str(caught)]  # survivors come twice
    assert "seed 4" in summary[-1]


def test_the_seed_decides_which_faults_are_drawn(tree: Path) -> None:
    def lines(seed: int) -> list[str]:
        return [mutant.lines(CODE)[2] for mutant in drawn("python", seed)]

    assert lines(1) == lines(1)
    assert len({tuple(lines(seed)) for seed in range(8)}) > 1
    assert all(len(lines(seed)) == 3 for seed in range(8))  # one fault of each line that has any


def test_a_changed_test_is_watched_anew(tree: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    checkout, kept = Checkout(tmp_path / "job"), tmp_path / "seen.json"
    checkout.refresh(tree)
    record([checkout], kept)
    capsys.readouterr()
    record([checkout], kept)
    assert capsys.readouterr().out == ""
    (tree / "tests" / "test_code_.py").write_text(TEST + "\ndef test_fails():\n    assert larger(1, 2)\n")
    checkout.refresh(tree)
    assert not record([checkout], kept)["tests/test_code_.py"].passes
    assert "FAILS" in capsys.readouterr().out


def test_faults_meet_the_tests_that_enter_their_function() -> None:
    seen = {
        "tests/test_b.py": Seen("", 3, True, {"a.py": ["<module>", "f"]}, ["a.cs"]),
        "tests/test_c.py": Seen("", 2, True, {"a.py": ["<module>", "f", "g"]}, []),
        "tests/test_a.py": Seen("", 9, True, {"a.py": ["<module>", "f"]}, ["a.cs"]),
        "tests/test_d.py": Seen("", 1, False, {"a.py": ["<module>", "f", "g"]}, ["a.cs"]),
        "tests/test_e.py": Seen("", 1, True, {"a.py": ["<module>"]}, []),
    }
    named_first_then_fastest = ["tests/test_a.py", "tests/test_c.py", "tests/test_b.py"]
    assert seeing(Mutant("a.py", "sign", 0, 1, "", "f"), seen, {}) == named_first_then_fastest
    assert seeing(Mutant("a.py", "sign", 0, 1, "", "g"), seen, {}) == ["tests/test_c.py"]
    assert seeing(Mutant("a.py", "sign", 0, 1, "", ""), seen, {}) == named_first_then_fastest  # outside of any function
    caught = {(".", "tests/test_b.py"): 2, ("b", "tests/test_c.py"): 9}
    assert seeing(Mutant("a.py", "sign", 0, 1, "", "f"), seen, caught)[1:] == ["tests/test_b.py", "tests/test_c.py"]
    assert seeing(Mutant("a.cs", "sign", 0, 1, ""), seen, {}) == ["tests/test_a.py", "tests/test_b.py"]


def test_what_does_not_compile_counts_apart() -> None:
    mutant = Mutant("a.hlsl", "sign", 0, 1, "")
    results = [CAUGHT, TIMED_OUT, CAUGHT, SURVIVED, UNCOMPILED, EQUAL]
    last = table({"hlsl": [Outcome(mutant, each, "") for each in results if each != SURVIVED]}).splitlines()[-1]
    assert last.split() == ["all", "3", "3", "100.0", "%", "1", "1"]
    for printed in ("a.cs(3,4): error CS0019: no", "a.hlsl: Sort does not compile: x", "ERROR: a.hlsl:3:4: no"):
        assert mutant_tests.NOT_COMPILED.search(f"E   {printed}" if "ERROR:" not in printed else printed)


def test_every_listed_fault_stands_where_the_list_says() -> None:
    known = run_mutants.tomllib.loads(run_mutants.EQUIVALENT.read_text())["equivalent"]
    for entry in known:
        found = [
            mutant
            for path in run_mutants.ROOT.glob(entry["file"])
            for mutant in (mutants(path, run_mutants.ROOT) if path.is_file() else [])
            if reason(mutant, path.read_text(), [entry])
        ]
        assert found, entry
