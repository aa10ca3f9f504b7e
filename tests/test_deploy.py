"""The whole of mua-deploy against a fake headset: what it does, and one sentence for each way to fail."""

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from fake_adb import serving
from fake_headset import PACKAGE, VRAPI, FakeHeadset, unity, vrapi
from synthetic_avatar import synthetic_avatar

from mua.asset import write
from mua.cli.deploy import run
from mua.deploy import player

# adbutils leaves a socket open where a device refuses.
pytestmark = pytest.mark.filterwarnings("ignore:unclosed <socket:ResourceWarning")

FOLDER = f"/sdcard/Android/data/{PACKAGE}/files/avatars"
HERO = f"{FOLDER}/hero.muaavatar"
# A shell's background job, which a test run may be, starts with Ctrl-C ignored, and its children inherit that.
HEAR_CTRL_C = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler); "
RUN = "from mua.cli.deploy import run; run()"
STEADY = {
    "debug.oculus.cpuLevel": "4",
    "debug.oculus.gpuLevel": "4",
    "debug.oculus.refreshRate": "72",
    "debug.oculus.foveation.dynamic": "0",
}


@pytest.fixture
def hero(tmp_path: Path) -> Path:
    path = tmp_path / "hero.muaavatar"
    write(path, synthetic_avatar())
    return path


@pytest.fixture
def apk(tmp_path: Path) -> Path:
    path = tmp_path / "player.apk"
    path.write_bytes(b"PK\3\4" + bytes(200_000))
    return path


def deploy(monkeypatch: pytest.MonkeyPatch, *arguments: str | Path) -> int:
    """Exit code of the command."""
    monkeypatch.setattr(sys, "argv", ["mua-deploy", *map(str, arguments)])
    with pytest.raises(SystemExit) as ended:
        run()
    return int(ended.value.code or 0)


@contextmanager
def refused(capsys: pytest.CaptureFixture[str], *parts: str) -> Iterator[None]:
    """What is on standard error is one sentence with these parts."""
    yield
    error = capsys.readouterr().err
    assert error.startswith("error: ")
    assert error.count("\n") == 1
    for part in parts:
        assert part in error


def run_of(arguments: list[str]) -> str:
    return arguments[arguments.index("-muaRun") + 1]


def passing(arguments: list[str]) -> list[str]:
    said = ("START 3", "PASS mlp_matmul/odd", "PASS splat_sort/empty", "PASS splat_sort/one", "PASS 3/3")
    return [unity(f"MUA-SELFTEST {run_of(arguments)} {text}") for text in said]


def failing(arguments: list[str]) -> list[str]:
    said = ("START 2", "FAIL mlp_matmul/odd: differs by 0.5 at 7: 1.0", "PASS splat_sort/one", "FAIL 1/2")
    return [unity(f"MUA-SELFTEST {run_of(arguments)} {text}") for text in said]


def playing(arguments: list[str]) -> list[str]:
    before, run = vrapi(VRAPI.replace("72/72", "10/72")), run_of(arguments)
    seconds = int(arguments[arguments.index("-muaSeconds") + 1])
    begin, end = unity(f"MUA-BENCH {run} START hero"), unity(f"MUA-BENCH {run} END")
    return [before, begin, *[vrapi()] * seconds, end, before]


def test_installs_pushes_and_starts(monkeypatch: pytest.MonkeyPatch, hero: Path, apk: Path) -> None:
    headset = FakeHeadset(packages=set())
    with serving(monkeypatch, headset):
        assert deploy(monkeypatch, hero, "--apk", apk) == 0
    assert headset.packages == {PACKAGE}
    assert headset.files == {HERO: hero.read_bytes()}
    assert headset.started == [["-muaAvatar", "hero"]]
    assert any("pm install -r -g" in asked for asked in headset.asked)


def test_works_with_a_headset_that_tells_no_exit_codes(monkeypatch: pytest.MonkeyPatch, hero: Path) -> None:
    headset = FakeHeadset(features="cmd")
    with serving(monkeypatch, headset):
        assert deploy(monkeypatch, hero) == 0
    assert headset.files == {HERO: hero.read_bytes()}


def test_builds_with_unity_what_it_installs(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    from test_deploy_build import fake_unity, project

    editor = fake_unity(tmp_path, "printf 'PK\\003\\004apk' > \"$apk\"")
    headset = FakeHeadset(packages=set())
    with serving(monkeypatch, headset):
        assert deploy(monkeypatch, "--unity", editor, "--project", project(tmp_path)) == 0
    assert headset.packages == {PACKAGE}


@pytest.mark.parametrize(
    ("headsets", "sentence"),
    [
        ([], "no headset is attached"),
        ([FakeHeadset(state="unauthorized")], "2G0YC1 has not allowed this computer: put it on"),
        ([FakeHeadset(state="offline")], "2G0YC1 is offline: unplug it"),
        ([FakeHeadset(state="no permissions (user in plugdev group)")], "2G0YC1 may not be opened by this user"),
        ([FakeHeadset("A"), FakeHeadset("B")], "2 headsets are attached (A, B): choose one with --serial"),
    ],
)
def test_names_what_keeps_it_from_the_headset(
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    hero: Path,
    headsets: list[FakeHeadset],
    sentence: str,
) -> None:
    with serving(monkeypatch, *headsets), refused(capsys, sentence):
        assert deploy(monkeypatch, hero) == 1
    assert all(headset.asked == [] for headset in headsets)


def test_serial_chooses_between_headsets(monkeypatch: pytest.MonkeyPatch, hero: Path) -> None:
    first, second = FakeHeadset("A"), FakeHeadset("B")
    with serving(monkeypatch, first, second):
        assert deploy(monkeypatch, hero, "--serial", "B") == 0
    assert (list(first.files), list(second.files)) == ([], [HERO])


def test_refuses_an_absent_serial(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    with serving(monkeypatch, FakeHeadset("A")), refused(capsys, "--serial is 'C'; attached are A"):
        assert deploy(monkeypatch, "--serial", "C") == 1


def test_refuses_without_a_server(monkeypatch: pytest.MonkeyPatch) -> None:
    with serving(monkeypatch):
        pass  # its port is free again
    monkeypatch.setenv("ADBUTILS_ADB_PATH", "/absent/adb")
    # A process of its own, because adbutils leaves a socket open where it cannot connect.
    refused = subprocess.run([sys.executable, "-c", RUN], capture_output=True, text=True, check=False)
    assert refused.returncode == 1
    assert refused.stderr.startswith("error: the adb server at 127.0.0.1:")
    assert refused.stderr.count("\n") == 1


def test_refuses_a_damaged_avatar_before_it_looks_for_a_headset(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], hero: Path
) -> None:
    hero.write_bytes(hero.read_bytes()[:-1])
    with refused(capsys, f"{hero}: "):
        assert deploy(monkeypatch, hero) == 1


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["--apk", "a.apk", "--project", "p"], "--apk and --project are both given"),
        (["--unity", "u"], "--unity is given without --project"),
        (["--project", "absent"], "--project is absent, which has no ProjectSettings"),
        (["--bench", "5"], "expected at least one AVATAR"),
        (["--json", "a.json"], "expected --bench SECONDS"),
        (["--rate", "71"], "--rate is 71; expected one of 72, 80, 90, 120"),
        (["--apk", "absent.apk"], "absent.apk: No such file"),
        (["--apk", __file__], "expected an APK"),
    ],
)
def test_refuses_options_that_make_no_sense(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], arguments: list[str], sentence: str
) -> None:
    with refused(capsys, sentence):
        assert deploy(monkeypatch, *arguments) == 1


def test_says_that_the_player_is_not_installed(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], hero: Path
) -> None:
    headset = FakeHeadset(packages=set())
    with serving(monkeypatch, headset), refused(capsys, f"{PACKAGE} is not installed", "--apk FILE"):
        assert deploy(monkeypatch, hero) == 1
    assert headset.files == {}


def test_says_why_the_headset_refuses_an_apk(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], apk: Path
) -> None:
    answer = "Failure [INSTALL_FAILED_UPDATE_INCOMPATIBLE: Existing package com.mua.player signatures do not match]"
    headset = FakeHeadset(install_answer=answer)
    with serving(monkeypatch, headset), refused(capsys, "INSTALL_FAILED_UPDATE_INCOMPATIBLE", "adb uninstall"):
        assert deploy(monkeypatch, "--apk", apk) == 1
    assert headset.files == {}
    assert not any("uninstall" in asked for asked in headset.asked)


@pytest.mark.parametrize(
    ("headset", "sentence"),
    [
        (FakeHeadset(cut_after=1), "failed with"),
        (FakeHeadset(refuses_push="couldn't write: No space left on device"), "No space left on device"),
        (FakeHeadset(loses_tail=True), "is its storage full?"),
    ],
)
def test_leaves_nothing_half_pushed(
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    hero: Path,
    headset: FakeHeadset,
    sentence: str,
) -> None:
    headset.files[HERO] = b"the one before"
    with serving(monkeypatch, headset), refused(capsys, "2G0YC1: ", sentence):
        assert deploy(monkeypatch, hero) == 1
    assert headset.files == {HERO: b"the one before"}
    assert headset.started == []


def test_a_headset_that_vanishes_while_pushed_to_keeps_no_half_avatar(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], hero: Path
) -> None:
    headset = FakeHeadset(cut_after=1, gone_after_cut=True)
    with serving(monkeypatch, headset), refused(capsys, "2G0YC1: pushing"):
        assert deploy(monkeypatch, hero) == 1
    assert HERO not in headset.files


def test_says_that_the_player_does_not_start(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    headset = FakeHeadset(start_answer="Error type 3\nError: Activity class does not exist.")
    with serving(monkeypatch, headset), refused(capsys, "starting com.mua.player failed", "does not exist"):
        assert deploy(monkeypatch) == 1


def test_self_test_passes(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    headset = FakeHeadset(player=passing)
    with serving(monkeypatch, headset):
        assert deploy(monkeypatch, "--self-test") == 0
    assert "3 of 3 cases passed" in capsys.readouterr().out
    assert headset.started[0][0] == "-muaSelfTest"
    assert not headset.worn


def test_self_test_names_the_first_failed_case(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    sentence = "1 of 2 cases failed on 2G0YC1, the first is mlp_matmul/odd: differs by 0.5 at 7: 1.0"
    with serving(monkeypatch, FakeHeadset(player=failing)), refused(capsys, sentence):
        assert deploy(monkeypatch, "--self-test") == 1


def test_self_test_does_not_believe_an_earlier_run(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(player, "PATIENCE", 0.2)
    headset = FakeHeadset(log=passing(["-muaRun", "00000000"]), keeps_log=True)
    with serving(monkeypatch, headset), refused(capsys, "nothing came from the player in time"):
        assert deploy(monkeypatch, "--self-test") == 1
    assert not headset.worn


def test_self_test_stops_waiting_although_the_log_goes_on(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(player, "PATIENCE", 0.2)

    def idle(arguments: list[str]) -> Iterator[str]:
        for _ in range(10):
            time.sleep(0.1)
            yield vrapi()

    headset = FakeHeadset(player=idle)
    with serving(monkeypatch, headset), refused(capsys, "nothing came from the player in time"):
        assert deploy(monkeypatch, "--self-test") == 1


def test_self_test_says_that_the_log_ended(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    headset = FakeHeadset(player=lambda arguments: passing(arguments)[:-1], log_ends=True)
    with serving(monkeypatch, headset), refused(capsys, "the log ended before the player was done"):
        assert deploy(monkeypatch, "--self-test") == 1


def test_self_test_tells_a_crash(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    def crash(arguments: list[str]) -> list[str]:
        lines = ("FATAL EXCEPTION: main", f"Process: {PACKAGE}, PID: 1", "java.lang.UnsatisfiedLinkError: openxr")
        return [f"11-21 12:00:00.000 E/AndroidRuntime( 4242): {line}" for line in lines]

    with serving(monkeypatch, FakeHeadset(player=crash)), refused(capsys, "crashed: java.lang.UnsatisfiedLinkError"):
        assert deploy(monkeypatch, "--self-test") == 1


def test_bench_measures_at_steady_clocks_and_puts_them_back(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], hero: Path, tmp_path: Path
) -> None:
    during: dict[str, str] = {}

    def look(arguments: list[str]) -> list[str]:
        during.update(headset.properties, worn=str(headset.worn))
        return playing(arguments)

    headset = FakeHeadset(player=look)
    with serving(monkeypatch, headset):
        assert deploy(monkeypatch, hero, "--bench", "5", "--json", tmp_path / "bench.json") == 0
    assert during.items() >= {**STEADY, "worn": "True"}.items()
    assert {name: headset.properties[name] for name in STEADY} == {
        **dict.fromkeys(STEADY, ""),
        "debug.oculus.gpuLevel": "2",
    }
    assert not headset.worn
    (benched,) = json.loads((tmp_path / "bench.json").read_text())["benched"]
    assert (benched["avatar"], benched["model"], len(benched["samples"])) == ("hero", "Quest 3", 5)
    assert benched["figures"]["app_ms"] == {"min": 4.49, "median": 4.49, "p95": 4.49}
    assert benched["figures"]["fps"]["min"] == 72
    assert benched["warnings"] == []
    shown = capsys.readouterr().out
    assert "hero on Quest 3, 5 of 5 seconds at 72 Hz" in shown
    assert "app ms" in shown


def test_bench_puts_the_headset_back_after_an_error(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], hero: Path, tmp_path: Path
) -> None:
    headset = FakeHeadset(player=lambda a: [unity(f"MUA-BENCH {run_of(a)} FAIL avatars/hero.muaavatar: crc32")])
    with serving(monkeypatch, headset), refused(capsys, "the player cannot measure: avatars/hero.muaavatar: crc32"):
        assert deploy(monkeypatch, hero, "--bench", "5", "--json", tmp_path / "bench.json") == 1
    assert headset.properties["debug.oculus.gpuLevel"] == "2"
    assert not headset.worn
    assert not (tmp_path / "bench.json").exists()


def test_bench_puts_the_headset_back_where_a_setting_is_refused(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], hero: Path
) -> None:
    headset = FakeHeadset(frozen=frozenset({"debug.oculus.refreshRate"}))
    with serving(monkeypatch, headset), refused(capsys, "debug.oculus.refreshRate is '' after setting it"):
        assert deploy(monkeypatch, hero, "--bench", "5") == 1
    assert headset.properties["debug.oculus.gpuLevel"] == "2"
    assert headset.started == []


def test_bench_says_that_a_lost_headset_keeps_its_settings(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], hero: Path
) -> None:
    def unplug(arguments: list[str]) -> list[str]:
        headset.state, headset.log_ends = "offline", True
        return []

    headset = FakeHeadset(player=unplug)
    with (
        serving(monkeypatch, headset),
        refused(capsys, "2G0YC1: ", "keeps its measuring settings until it is restarted"),
    ):
        assert deploy(monkeypatch, hero, "--bench", "5") == 1


@pytest.mark.skipif(os.name == "nt", reason="Ctrl-C is sent to one process by POSIX signals only")
def test_bench_puts_the_headset_back_after_ctrl_c(monkeypatch: pytest.MonkeyPatch, hero: Path) -> None:
    headset = FakeHeadset()
    with serving(monkeypatch, headset):
        command = [sys.executable, "-c", HEAR_CTRL_C + RUN, str(hero), "--bench", "60"]
        with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE) as deploying:
            until = time.monotonic() + 60
            while not headset.started and time.monotonic() < until:
                time.sleep(0.02)
            assert headset.properties["debug.oculus.gpuLevel"] == "4"
            deploying.send_signal(signal.SIGINT)
            try:
                _, error = deploying.communicate(timeout=30)
            finally:
                deploying.kill()  # of no effect on one that ended
    assert deploying.returncode != 0
    assert b"Traceback" not in error
    assert headset.properties["debug.oculus.gpuLevel"] == "2"
    assert not headset.worn
