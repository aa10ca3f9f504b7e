"""Runs one kernel's parity tests against a copy of the shaders, first as it is, then once for every fault.

MUA_SHADERS=<copy> python mutate.py <kernel>      prints a JSON object: `unmutated` and each fault, with what came of it
"""

import contextlib
import io
import json
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from fault import Fault
from mutations import FAULTS

from mua.errors import InputError
from mua.gpu import sources
from mua.gpu.compile import spirv

HERE = Path(__file__).parent
UNMUTATED = "unmutated"
PASSED, CAUGHT = "passed", "caught"


def outcomes(kernel: str) -> dict[str, str]:
    """`passed`, `caught` or what kept the test from saying, of the copy as it is and of every fault of the kernel."""
    found = {UNMUTATED: _outcome(kernel)}
    for fault in FAULTS[kernel]:
        with _applied(fault, kernel):
            found[fault.breaks] = _outcome(kernel)
    return found


def path_of(fault: Fault, kernel: str) -> Path:
    return sources.find(fault.file or f"{kernel}.compute")


@contextlib.contextmanager
def _applied(fault: Fault, kernel: str) -> Iterator[None]:
    path = path_of(fault, kernel)
    text = path.read_text()
    path.write_text(text.replace(fault.original, fault.replacement))
    try:
        yield
    finally:
        path.write_text(text)


class FirstFailure:
    """Notes what the first failing test raised."""

    def __init__(self) -> None:
        self.raised = ""

    def pytest_runtest_makereport(self, call: pytest.CallInfo[None]) -> None:
        if call.excinfo and not self.raised:
            self.raised = call.excinfo.typename


def _outcome(kernel: str) -> str:
    """A test that fails because the fault does not compile or bind (InputError) has not caught it."""
    own = sources.directory() / f"{kernel}.compute"
    try:
        for shader in [own] if own.is_file() else sorted(sources.directory().glob("*.compute")):
            for entry in sources.kernels(shader.read_text()):
                spirv(shader, entry)
    except InputError as error:
        return str(error)
    first = FirstFailure()
    arguments = ["-x", "-q", "--tb=short", "-p", "no:cacheprovider", *map(str, sorted(HERE.glob(f"test_{kernel}*.py")))]
    with contextlib.redirect_stdout(io.StringIO()) as printed:
        code = pytest.main(arguments, plugins=[first])
    if code == pytest.ExitCode.OK:
        return PASSED
    return CAUGHT if code == pytest.ExitCode.TESTS_FAILED and first.raised != "InputError" else printed.getvalue()


if __name__ == "__main__":
    print(json.dumps(outcomes(sys.argv[1])))
