"""Runs tests for mutant_tests.py in the working directory: each order is met by a fork of what imported the arguments.

An order is a line of JSON on standard input, the answer a line on standard output, what pytest prints goes to a file.
"""

import importlib
import json
import os
import resource
import signal
import sys
from collections.abc import Generator
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from mutant_watcher import Watcher

MOST_MEMORY = 8 << 30
WORDS = ("-q", "--tb=short", "-p", "no:cacheprovider", "-p", "no:randomly")


class Chosen:
    """Of the tests that pytest finds these alone run, all where there are none; notes those that fail."""

    def __init__(self, tests: list[str]) -> None:
        self._tests, self.failed = set(tests), list[str]()

    @pytest.hookimpl(trylast=True)
    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        items[:] = [item for item in items if not self._tests or item.nodeid in self._tests]

    def pytest_runtest_logreport(self, report: Any) -> None:
        self.failed += [report.nodeid] if report.failed else []

    pytest_collectreport = pytest_runtest_logreport


class Watched:
    """Tells the watcher which test runs, or which fixture is set up that tests share."""

    def __init__(self) -> None:
        self._watcher = Watcher()

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: Any) -> Generator[None, object, object]:
        with self._watcher.within(item.nodeid, *item.fixturenames):
            return (yield)

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(self, fixturedef: Any) -> Generator[None, object, object]:
        if fixturedef.scope == "function":
            return (yield)
        with self._watcher.within(fixturedef.argname):
            return (yield)


def run(order: dict[str, Any]) -> list[str]:
    """Tests that fail; the first file by itself, then ever more at once, so that most faults need no more than one."""
    os.environ.update(order["environment"])
    plugins: list[object] = [chosen := Chosen(order["tests"])]
    plugins += [Watched()] if order["watch"] else []
    words = WORDS if order["watch"] else (*WORDS, "-x")
    files, size = order["files"], 1
    while files and not chosen.failed:
        status = pytest.main([*words, *files[:size]], plugins=plugins)
        if status not in (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED) and not chosen.failed:
            chosen.failed.append(f"exit status {int(status)}")
        files, size = files[size:], 2 * size
    return chosen.failed


def answer(order: dict[str, Any]) -> dict[str, Any]:
    """What came of an order: tests that fail, or that its time was over."""
    result = Path(order["printed"]).with_suffix(".json")
    result.unlink(missing_ok=True)
    child = os.fork()
    if child == 0:
        os.setsid()
        _limit(order["seconds"])
        for descriptor in (1, 2):
            os.dup2(os.open(order["printed"], os.O_WRONLY | os.O_CREAT | os.O_APPEND), descriptor)
        result.write_text(json.dumps(run(order)))
        os._exit(0)
    try:
        _, status = os.waitpid(child, 0)
    finally:
        with suppress(ProcessLookupError):
            os.killpg(child, signal.SIGKILL)  # what a test leaves running too
    over = os.WIFSIGNALED(status) and os.WTERMSIG(status) in (signal.SIGALRM, signal.SIGXCPU)
    return {"over": over, "failed": json.loads(result.read_text()) if result.is_file() else ["no test ended"]}


def _limit(seconds: int) -> None:
    """Let a fault that never ends, or asks for ever more memory, harm nobody."""
    signal.alarm(seconds)
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))  # of children too
    resource.setrlimit(resource.RLIMIT_DATA, (MOST_MEMORY, MOST_MEMORY))
    with suppress(OSError):
        Path("/proc/self/oom_score_adj").write_text("1000")


def main() -> None:
    for name in sys.argv[1:]:
        with suppress(ImportError):
            importlib.import_module(name)
    sys.path[0] = str(Path.cwd())  # as `python -m pytest` has it
    for line in sys.stdin:
        print(json.dumps(answer(json.loads(line))), flush=True)


if __name__ == "__main__":
    main()
