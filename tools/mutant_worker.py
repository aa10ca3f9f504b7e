"""Runs tests for mutant_tests.py in the working directory: each order is met by a fork of what imported the arguments.

An order is a line of JSON on standard input, the answer a line on standard output, what pytest prints goes to a file.
"""

import importlib
import json
import os
import resource
import select
import signal
import sys
import time
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
        _limit()
        for descriptor in (1, 2):
            os.dup2(os.open(order["printed"], os.O_WRONLY | os.O_CREAT | os.O_APPEND), descriptor)
        result.write_text(json.dumps(run(order)))
        os._exit(0)
    try:
        over = _outlasts(child, order["seconds"], order["waiting"])
    finally:
        with suppress(ProcessLookupError):
            os.killpg(child, signal.SIGKILL)  # what a test leaves running too
        os.waitpid(child, 0)
    return {"over": over, "failed": json.loads(result.read_text()) if result.is_file() else ["no test ended"]}


def _outlasts(child: int, seconds: float, waiting: float) -> bool:
    """Whether a process with its children takes more CPU time, which no other work changes, or waits longer."""
    used, changed, ended = 0.0, time.monotonic(), os.pidfd_open(child)
    try:
        while not select.select([ended], [], [], 1)[0]:
            if (now := _cpu_seconds(child)) != used:
                used, changed = now, time.monotonic()
            if used > seconds or time.monotonic() - changed > waiting:
                return True
    finally:
        os.close(ended)
    return False


def _cpu_seconds(session: int) -> float:
    """What the processes of a session and those that they waited for have taken."""
    ticks = 0
    for stat in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError):
            words = stat.read_text().rpartition(")")[2].split()
            ticks += sum(map(int, words[11:15])) if int(words[3]) == session else 0
    return ticks / os.sysconf("SC_CLK_TCK")


def _limit() -> None:
    """Let a fault that asks for ever more memory harm nobody."""
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
