"""Features that stop working are noticed: every fault of planted.toml, put into a copy of the tree, fails its test.

A fault is an edit of the kind that a hurried engineer makes: an option that is read and ignored, the left hand for the
right one, state that outlives its object. Faults of the shaders are in tests/parity/mutations.py.
"""

import os
import shutil
import signal
import subprocess
import sys
import tomllib
from collections.abc import Iterable, Iterator
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryFile
from typing import NamedTuple

import pytest

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
SECONDS = 900  # tests that have not ended by then go on for ever, by which a fault is noticed too


class Fault(NamedTuple):
    """What is wrong once `original`, which stands once in `file`, reads `replacement`."""

    breaks: str
    file: str
    original: str
    replacement: str
    tests: list[str]  # that notice, as pytest names them, from the top of the checkout

    def applied_to(self, text: str) -> str:
        return text.replace(self.original, self.replacement)


FAULTS = [Fault(**entry) for entry in tomllib.loads((HERE / "planted.toml").read_text())["fault"]]


def name(fault: Fault) -> str:
    return f"{Path(fault.file).stem}: {fault.breaks}"


@pytest.fixture(scope="session")
def copied_tree(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """The tracked files of the checkout, with what its tests find beside it and in folders that git ignores."""
    copy = tmp_path_factory.mktemp("copy") / "tree"
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    for file in filter(None, listed.split("\0")):
        (copy / file).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(ROOT / file, copy / file)
    for beside, ignored in ((ROOT.parent / "shared", copy.parent / "shared"), (ROOT / "build", copy / "build")):
        if beside.exists():
            ignored.symlink_to(beside)
    modules = Path("tests") / "web" / "node_modules"
    if (ROOT / modules).exists():
        (copy / modules).symlink_to(ROOT / modules)
    yield copy
    shutil.rmtree(copy)


def ran(tree: Path, tests: Iterable[str]) -> tuple[int | None, str]:
    """The exit status of tests in a copy of the tree, None where they do not end, and what they printed."""
    command = [sys.executable, "-m", "pytest", "-c", "pyproject.toml", "-x", "-n0", "-p", "no:randomly", *tests]
    environment = {**os.environ, "PYTHONPATH": str(tree / "python")}
    environment.pop("PYTEST_XDIST_WORKER", None)
    command += ["-p", "no:cacheprovider", "-m", "not long and not gallery"]
    with (
        TemporaryFile("w+") as printed,
        subprocess.Popen(
            command, cwd=tree, env=environment, stdout=printed, stderr=subprocess.STDOUT, start_new_session=True
        ) as process,
    ):
        try:
            status = process.wait(SECONDS)
        except subprocess.TimeoutExpired:
            status = None
        finally:
            with suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)  # what tests have left running too
        printed.seek(0)
        return status, printed.read()


@pytest.mark.parametrize("fault", FAULTS, ids=name)
def test_a_fault_can_be_planted(fault: Fault) -> None:
    assert (ROOT / fault.file).read_text().count(fault.original) == 1
    assert fault.applied_to(fault.original) != fault.original
    assert fault.tests
    assert all((ROOT / test.partition("::")[0]).is_file() for test in fault.tests)


@pytest.mark.long
def test_all_pass_without_faults(copied_tree: Path) -> None:
    status, printed = ran(copied_tree, dict.fromkeys(test for fault in FAULTS for test in fault.tests))
    assert status == pytest.ExitCode.OK, printed


@pytest.mark.long
@pytest.mark.parametrize("fault", FAULTS, ids=name)
def test_a_planted_fault_is_noticed(copied_tree: Path, fault: Fault) -> None:
    planted = copied_tree / fault.file
    sound = planted.read_text()
    planted.write_text(fault.applied_to(sound))
    try:
        status, printed = ran(copied_tree, fault.tests)
        assert status in (pytest.ExitCode.TESTS_FAILED, None), printed
    finally:
        planted.write_text(sound)
