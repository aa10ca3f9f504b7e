"""The fake adb server speaks the protocol as the real adb does."""

import subprocess
from pathlib import Path

import adbutils
import pytest
from fake_adb import FakeAdb, serving
from fake_headset import FakeHeadset

from mua.deploy.headset import connect


def real_adb(server: FakeAdb, *arguments: str) -> subprocess.CompletedProcess[str]:
    command = [adbutils.adb_path(), "-P", str(server.port), *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=20)


def test_real_adb_lists_asks_and_pushes(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    headset = FakeHeadset()
    (tmp_path / "a.bin").write_bytes(bytes(range(256)) * 300)
    with serving(monkeypatch, headset) as server:
        assert "2G0YC1\tdevice" in real_adb(server, "devices").stdout
        assert real_adb(server, "-s", "2G0YC1", "shell", "getprop", "ro.product.model").stdout == "Quest 3\n"
        assert real_adb(server, "-s", "2G0YC1", "shell", "nonsense").returncode == 127
        pushed = real_adb(server, "-s", "2G0YC1", "push", str(tmp_path / "a.bin"), "/data/local/tmp/a.bin")
        assert pushed.returncode == 0, pushed.stderr
    assert headset.files["/data/local/tmp/a.bin"] == bytes(range(256)) * 300


def test_real_adb_hears_refusals(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    (tmp_path / "a.bin").write_bytes(b"1")
    full = FakeHeadset("A", refuses_push="couldn't create file: No space left on device")
    with serving(monkeypatch, full, FakeHeadset("B", state="unauthorized")) as server:
        refused = real_adb(server, "-s", "A", "push", str(tmp_path / "a.bin"), "/sdcard/a.bin")
        assert (refused.returncode, "No space left" in refused.stderr) == (1, True)
        assert "unauthorized" in real_adb(server, "-s", "B", "shell", "getprop").stderr
        assert "not found" in real_adb(server, "-s", "C", "shell", "getprop").stderr


def test_lines_of_a_log_come_whole_however_they_are_cut_on_their_way(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("mua.deploy.headset.CHUNK", 7)
    lines = ["MUA-BENCH 1 START 2", "", "a line of more than seven bytes"]
    with serving(monkeypatch, FakeHeadset(log=lines, log_ends=True)):
        assert list(connect().log("Unity", silence=5.0)) == lines
