"""A run over a small tree: what tests catch, what survives, what is known as no fault."""

import subprocess
from collections import Counter
from collections.abc import Iterator
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import mutant_tests
import pytest
import run_mutants
from mutant_sites import Mutant, mutants
from mutant_tests import BOUND, Checkout, SeenTest, afforded, record, seeing
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
    monkeypatch.setattr(mutant_tests, "IMPORTED", ())
    monkeypatch.setattr(run_mutants, "ROOT", root)
    monkeypatch.setattr(run_mutants, "EQUIVALENT", root / "equivalent.toml")
    monkeypatch.setattr(run_mutants, "LANGUAGES", {"python": ("python/*.py",)})
    return root


@pytest.fixture
def checkout(tmp_path: Path) -> Iterator[Checkout]:
    with closing(Checkout(tmp_path / "job")) as opened:
        yield opened


def test_each_fault_ends_as_caught_survived_or_equivalent(tree: Path, tmp_path: Path, checkout: Checkout) -> None:
    checkout.refresh(tree)
    tests = record([checkout], tmp_path / "seen")
    code = {f"python/code_.py\t{function}" for function in ("<module>", "halved", "larger")}
    assert [(test.name, test.places) for test in tests] == [("tests/test_code_.py::test_it", code)]
    found = {
        each.mutant.lines(CODE)[2]: each
        for each in run(iter(mutants(tree / "python/code_.py", tree)), 9, [checkout], tests, Counter())
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


def test_a_changed_test_is_watched_anew(
    tree: Path, tmp_path: Path, checkout: Checkout, capsys: pytest.CaptureFixture[str]
) -> None:
    kept = tmp_path / "seen"
    checkout.refresh(tree)
    record([checkout], kept)
    capsys.readouterr()
    record([checkout], kept)
    assert capsys.readouterr().out == ""
    (tree / "tests" / "test_code_.py").write_text(TEST + "\ndef test_fails():\n    assert larger(1, 2)\n")
    checkout.refresh(tree)
    assert [test.name for test in record([checkout], kept)] == ["tests/test_code_.py::test_it"]
    assert "FAILS tests/test_code_.py::test_fails" in capsys.readouterr().out


SHARED = """
import subprocess, sys
import pytest
from code_ import halved, larger, unseen

@pytest.fixture(scope="module")
def shared():
    return larger(1, 2)

def test_a(shared): halved(2)
def test_b(shared): pass
def test_c(): subprocess.run([sys.executable, "-c", "import code_; code_.unseen(1)"], check=True)
"""


def test_tests_see_what_fixtures_and_child_processes_meet(tree: Path, tmp_path: Path, checkout: Checkout) -> None:
    (tree / "tests" / "test_code_.py").write_text(SHARED)
    checkout.refresh(tree)
    places = {test.function[-1]: test.places for test in record([checkout], tmp_path / "seen")}
    seen = {name: {place.split("\t")[1] for place in places[name]} - {"<module>"} for name in places}
    assert seen == {"a": {"larger", "halved"}, "b": {"larger"}, "c": {"unseen"}}


BURN = "import subprocess, sys\ndef test_it():\n    subprocess.run([sys.executable, '-c', 'while True: pass'])\n"


FULL = """
import resource
from code_ import halved, larger

def test_it():
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1, hard))
    halved(2)
    resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    larger(1, 2)
"""


def test_tests_on_a_full_disk_are_watched_too(tree: Path, tmp_path: Path, checkout: Checkout) -> None:
    (tree / "tests" / "test_code_.py").write_text(FULL)
    checkout.refresh(tree)
    [test] = record([checkout], tmp_path / "seen")
    assert test.places == {f"python/code_.py\t{function}" for function in ("<module>", "halved", "larger")}


@pytest.mark.parametrize("never_ends", ["import time\ndef test_it():\n    time.sleep(600)\n", BURN])
def test_a_fault_that_never_ends_is_stopped(tree: Path, never_ends: str, checkout: Checkout) -> None:
    (tree / "tests" / "test_code_.py").write_text(never_ends)
    checkout.refresh(tree)
    assert checkout.pytest(["tests/test_code_.py"], seconds=1.5, waiting=2)[0] is None
    (checkout.root / "tests" / "test_code_.py").write_text("def test_it():\n    assert False\n")
    assert checkout.pytest(["tests/test_code_.py"], seconds=60)[0] == ["tests/test_code_.py::test_it"]


LATE = """
from code_ import larger

def test_it():
    larger(2, 1)
    raise TimeoutError
"""


def test_a_test_that_is_late_without_the_fault_too_has_not_caught_it(
    tree: Path, tmp_path: Path, checkout: Checkout
) -> None:
    checkout.refresh(tree)
    tests = record([checkout], tmp_path / "seen")
    (checkout.root / "tests" / "test_code_.py").write_text(LATE)  # the machine is busy now
    [found] = run(iter(mutants(tree / "python/code_.py", tree)[:1]), 1, [checkout], tests, Counter())
    assert found.result == SURVIVED


def test_only_cpu_time_counts_whatever_else_the_machine_does(tree: Path, checkout: Checkout) -> None:
    (tree / "tests" / "test_code_.py").write_text("import time\ndef test_it():\n    time.sleep(2.5)\n")
    checkout.refresh(tree)
    assert checkout.pytest(["tests/test_code_.py"], seconds=2)[0] == []


def a_test(file: str, seconds: float, *places: str, fixtures: dict[str, float] | None = None) -> SeenTest:
    return SeenTest(file, f"{file}::test", seconds, set(places), fixtures or {})


def test_faults_meet_the_tests_that_enter_their_function() -> None:
    tests = [
        a_test("tests/test_b.py", 3, "a.py\t<module>", "a.py\tf", "a.cs"),
        a_test("tests/test_c.py", 2, "a.py\t<module>", "a.py\tf", "a.py\tg"),
        a_test("tests/test_a.py", 9, "a.py\t<module>", "a.py\tf", "a.cs"),
        a_test("tests/test_e.py", 1, "a.py\t<module>"),
    ]

    def order(path: str, function: str, caught: dict[tuple[str, str], int] | None = None) -> str:
        found = seeing(Mutant(path, "sign", 0, 1, "", function), tests, caught or {})
        return "".join(test.file[-4] for test in found)

    named_first_then_fastest = "acb"
    assert order("a.py", "f") == named_first_then_fastest
    assert order("a.py", "g") == "c"
    assert order("a.py", "") == named_first_then_fastest  # outside of any function
    caught = {(".", "tests/test_b.py::test"): 2, ("b", "tests/test_c.py::test"): 9}
    assert order("a.py", "f", caught) == "abc"
    assert order("a.cs", "") == "ab"
    tests.append(a_test("tests/test_f.py", 1, "folder/old.cs"))
    assert order("folder/new.cs", "") == "f"  # since the tests were watched
    many = [replace(tests[0], name=f"tests/test_b.py::test[{k}]", seconds=k, fixtures={}) for k in range(3)]
    found = seeing(Mutant("a.py", "sign", 0, 1, "", "f"), [*many, a_test("tests/test_z.py", 9, "a.py\tf")], {})
    assert [test.seconds for test in found] == [0, 1, 9, 2]
    tests[0] = a_test("tests/test_b.py", 3, "a.py\tf", fixtures={"trained": BOUND})
    assert order("a.py", "f", caught) == "acb"  # slow ones last
    parted = [a_test(f"tests/test_{name}.py", 1, "AvatarPose.cs") for name in ("drawn", "pose", "avatar_pose")]
    found = seeing(Mutant("AvatarPose.cs", "sign", 0, 1, ""), parted, {})
    assert [test.file for test in found] == ["tests/test_avatar_pose.py", "tests/test_pose.py", "tests/test_drawn.py"]


def test_tests_of_one_fault_keep_within_the_bound() -> None:
    shared = {"trained": BOUND / 2}
    first = a_test("tests/test_a.py", 1, fixtures=shared)
    same = a_test("tests/test_a.py", 1, fixtures=shared)
    other = a_test("tests/test_b.py", 1, fixtures=shared)
    short = a_test("tests/test_b.py", BOUND / 2 - 2)
    assert afforded([first, same, other, short]) == ([first, same, short], BOUND)
    slow = a_test("tests/test_a.py", 2 * BOUND)
    assert afforded([slow, short]) == ([slow], 2 * BOUND)


def test_what_does_not_compile_counts_apart() -> None:
    mutant = Mutant("a.hlsl", "sign", 0, 1, "")
    results = [CAUGHT, TIMED_OUT, CAUGHT, SURVIVED, UNCOMPILED, EQUAL]
    last = table({"hlsl": [Outcome(mutant, each, "") for each in results if each != SURVIVED]}).splitlines()[-1]
    assert last.split() == ["all", "3", "3", "100.0", "%", "1", "1"]
    for printed in ("a.cs(3,4): error CS0019: no", "a.hlsl: Sort does not compile: x", "ERROR: a.hlsl:3:4: no"):
        assert run_mutants.NOT_COMPILED.search(f"E   {printed}" if "ERROR:" not in printed else printed)


def test_every_listed_fault_stands_where_the_list_says() -> None:
    known = run_mutants.tomllib.loads(run_mutants.EQUIVALENT.read_text())["equivalent"]
    assert known
    for entry in known:
        found = [
            mutant
            for path in run_mutants.ROOT.glob(entry["file"])
            for mutant in (mutants(path, run_mutants.ROOT) if path.is_file() else [])
            if reason(mutant, path.read_text(), [entry])
        ]
        assert found, entry


def test_comments_after_a_line_do_not_matter_to_the_list() -> None:
    for path, sign in (("a.py", "#"), ("a.hlsl", "//")):
        text = f"reach = 2 {sign} texels\n"
        entry = {"file": path, "operator": "constant", "reason": "so", "becomes": "reach = 3"}
        mutant = Mutant(path, "constant", 8, 9, "3")
        for line in ("reach = 2", f"reach = 2 {sign} metres"):
            assert reason(mutant, text, [{**entry, "line": line}]) == "so"
        assert reason(mutant, text, [{**entry, "line": "reach = 1"}]) == ""
        assert reason(mutant, text, [{**entry, "line": "reach = 2", "becomes": "reach = 4"}]) == ""
