"""Work in a fork: what it returns, raises and tells arrives here, and it ends with the process that forked."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from silent import Silent

from mua.baking.forked import in_fork
from mua.baking.listener import Listener
from mua.errors import InputError

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="needs Linux, where a process with threads can fork")


class Kept(Silent):
    """Keeps what it hears."""

    def __init__(self) -> None:
        self.heard: list[object] = []

    def stage(self, name: str) -> None:
        self.heard.append(name)

    def step(self, done: int, total: int, *, detail: str = "") -> None:
        self.heard.append((done, total, detail))

    def note(self, sentence: str) -> None:
        self.heard.append(sentence)


def test_returns_what_another_process_found_and_hears_of_its_progress() -> None:
    def work(listener: Listener) -> int:
        listener.stage("recording")
        listener.note("Feet are held.")
        listener.step(1, 2, detail="2 at work")
        return os.getpid()

    kept = Kept()
    assert in_fork(work, kept) != os.getpid()
    assert kept.heard == ["recording", "Feet are held.", (1, 2, "2 at work")]


def test_raises_what_the_work_raises() -> None:
    def work(_: Listener) -> None:
        raise InputError("hero.glb: has no skin", "its meshes: body")

    with pytest.raises(InputError, match=r"^hero\.glb: has no skin$") as caught:
        in_fork(work, Silent())
    assert caught.value.details == "its meshes: body"


def test_an_error_of_the_program_keeps_the_place_where_it_was_raised() -> None:
    def work(_: Listener) -> None:
        raise ModuleNotFoundError("No module named 'pxr'", name="pxr")

    with pytest.raises(ModuleNotFoundError) as caught:
        in_fork(work, Silent())
    assert caught.value.name == "pxr"
    assert "test_forked.py" in "".join(caught.value.__notes__)


def test_a_killed_fork_is_a_sentence() -> None:
    def work(_: Listener) -> None:
        os.kill(os.getpid(), signal.SIGKILL)

    with pytest.raises(InputError, match="fits and records was ended by signal 9, perhaps for want of memory"):
        in_fork(work, Silent())


def test_an_error_of_the_listener_ends_the_fork() -> None:
    class Refusing(Silent):
        def note(self, sentence: str) -> None:
            raise BrokenPipeError(sentence)

    def work(listener: Listener) -> None:
        listener.note(str(os.getpid()))
        time.sleep(600)

    with pytest.raises(BrokenPipeError) as caught:
        in_fork(work, Refusing())
    assert not Path(f"/proc/{caught.value}").exists()


WAITING = """
import os, signal, sys, time
from pathlib import Path
from silent import Silent
from mua.baking.forked import in_fork

signal.signal(signal.SIGINT, signal.default_int_handler)  # also in a job in the background

def work(listener):
    try:
        Path(sys.argv[1]).write_text(str(os.getpid()))
        os.rename(sys.argv[1], sys.argv[1] + ".pid")
        time.sleep(600)
    finally:
        Path(sys.argv[1] + ".cleared").touch()

in_fork(work, Silent())
"""


@pytest.mark.parametrize("sign", [signal.SIGINT, signal.SIGKILL])
def test_ends_with_the_process_that_forked_and_clears_up_after_an_interrupt(
    tmp_path: Path, sign: signal.Signals
) -> None:
    flag = tmp_path / "work"
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    parent = subprocess.Popen(
        [sys.executable, "-c", WAITING, str(flag)], env=environment, stderr=subprocess.PIPE, text=True
    )
    while not flag.with_suffix(".pid").exists():
        assert parent.poll() is None
        time.sleep(0.01)
    parent.send_signal(sign)
    said = parent.communicate()[1]
    assert said.count("Traceback") == (sign == signal.SIGINT)  # the parent's own alone
    assert flag.with_suffix(".cleared").exists() == (sign == signal.SIGINT)
    while Path(f"/proc/{flag.with_suffix('.pid').read_text()}").exists():  # a killed process takes a moment
        time.sleep(0.01)
