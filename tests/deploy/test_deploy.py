"""All of mua-deploy against a fake headset: its work, and one sentence for each way to fail."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from commands import Commands, Ended, process
from fake_adb import serving
from fake_headset import PACKAGE, VRAPI, FakeHeadset, unity, vrapi
from synthetic_avatar import synthetic_avatar

from mua.asset import write
from mua.deploy import bench, player
from mua.errors import InputError

# adbutils leaves a socket open where a device refuses.
pytestmark = pytest.mark.filterwarnings("ignore:unclosed <socket:ResourceWarning")

FOLDER = f"/sdcard/Android/data/{PACKAGE}/files/avatars"
HERO = f"{FOLDER}/hero.muaavatar"
# A shell's background job, which a test run may be, starts with Ctrl-C ignored, and its children inherit that.
HEAR_CTRL_C = (
    "import signal; signal.signal(signal.SIGINT, signal.default_int_handler); from mua.cli.deploy import run; run()"
)
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


Deploy = Callable[..., Ended]  # with headsets attached, the command with its arguments


@pytest.fixture
def deploy(command: Commands, monkeypatch: pytest.MonkeyPatch) -> Deploy:
    def run(headsets: list[FakeHeadset], *arguments: str | Path) -> Ended:
        with serving(monkeypatch, *headsets):
            return command("deploy", *arguments)

    return run


def run_of(arguments: list[str]) -> str:
    return arguments[arguments.index("-muaRun") + 1]


def passing(arguments: list[str]) -> list[str]:
    lines = ("START 3", "PASS mlp_matmul/odd", "PASS splat_sort/empty", "PASS splat_sort/one", "PASS 3/3")
    return [unity(f"MUA-SELFTEST {run_of(arguments)} {text}") for text in lines]


def failing(arguments: list[str]) -> list[str]:
    lines = ("START 2", "FAIL mlp_matmul/odd: differs by 0.5 at 7: 1.0", "PASS splat_sort/one", "FAIL 1/2")
    return [unity(f"MUA-SELFTEST {run_of(arguments)} {text}") for text in lines]


def playing(arguments: list[str]) -> list[str]:
    before, run = vrapi(VRAPI.replace("72/72", "10/72")), run_of(arguments)
    seconds = int(arguments[arguments.index("-muaSeconds") + 1])
    begin, end = unity(f"MUA-BENCH {run} START hero"), unity(f"MUA-BENCH {run} END")
    return [before, begin, *[vrapi()] * seconds, end, before]


def test_installs_pushes_and_starts(deploy: Deploy, hero: Path, apk: Path) -> None:
    headset = FakeHeadset(packages=set())
    assert deploy([headset], hero, "--apk", apk).status == 0
    assert headset.packages == {PACKAGE}
    assert headset.files == {HERO: hero.read_bytes()}
    assert headset.started == [["-muaAvatar", "hero"]]
    assert any("pm install -r -g" in asked for asked in headset.asked)


def test_works_with_a_headset_without_exit_codes(deploy: Deploy, hero: Path) -> None:
    headset = FakeHeadset(features="cmd")
    assert deploy([headset], hero).status == 0
    assert headset.files == {HERO: hero.read_bytes()}


def test_builds_with_unity_what_it_installs(deploy: Deploy, tmp_path: Path) -> None:
    from fake_unity import fake_unity, project

    editor = fake_unity(tmp_path, "printf 'PK\\003\\004apk' > \"$apk\"")
    headset = FakeHeadset(packages=set())
    assert deploy([headset], "--unity", editor, "--project", project(tmp_path)).status == 0
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
    deploy: Deploy, hero: Path, headsets: list[FakeHeadset], sentence: str
) -> None:
    assert sentence in deploy(headsets, hero).sentence
    assert all(headset.asked == [] for headset in headsets)


def test_serial_chooses_between_headsets(deploy: Deploy, hero: Path) -> None:
    first, second = FakeHeadset("A"), FakeHeadset("B")
    assert deploy([first, second], hero, "--serial", "B").status == 0
    assert (list(first.files), list(second.files)) == ([], [HERO])
    assert "--serial is 'C'; attached are A" in deploy([first], "--serial", "C").sentence


def test_refuses_without_a_server(monkeypatch: pytest.MonkeyPatch) -> None:
    with serving(monkeypatch):
        pass  # its port is free again
    # A process of its own, because adbutils leaves a socket open where it cannot connect.
    refused = process("deploy", ADBUTILS_ADB_PATH="/absent/adb")
    assert refused.sentence.startswith("error: the adb server at 127.0.0.1:")


def test_refuses_a_damaged_avatar_before_it_looks_for_a_headset(command: Commands, hero: Path) -> None:
    hero.write_bytes(hero.read_bytes()[:-1])
    assert f"{hero}: " in command("deploy", hero).sentence


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
def test_refuses_options_that_make_no_sense(command: Commands, arguments: list[str], sentence: str) -> None:
    assert sentence in command("deploy", *arguments).sentence


def test_refuses_two_avatars_of_one_name(command: Commands, hero: Path, tmp_path: Path) -> None:
    (tmp_path / "other").mkdir()
    other = shutil.copy(hero, tmp_path / "other")
    assert f"{other}: another avatar of this call has the name 'hero' too" in command("deploy", hero, other).sentence


def test_says_that_the_player_is_not_installed(deploy: Deploy, hero: Path) -> None:
    headset = FakeHeadset(packages=set())
    message = deploy([headset], hero).sentence
    assert f"{PACKAGE} is not installed" in message
    assert "--apk FILE" in message
    assert headset.files == {}


def test_says_why_the_headset_refuses_an_apk(deploy: Deploy, apk: Path) -> None:
    answer = "Failure [INSTALL_FAILED_UPDATE_INCOMPATIBLE: Existing package com.mua.player signatures do not match]"
    headset = FakeHeadset(install_answer=answer)
    message = deploy([headset], "--apk", apk).sentence
    assert "INSTALL_FAILED_UPDATE_INCOMPATIBLE" in message
    assert "adb uninstall" in message
    assert headset.files == {}
    assert not any("uninstall" in asked for asked in headset.asked)


@pytest.mark.parametrize(
    ("headset", "sentence"),
    [
        (FakeHeadset(cut_after=1), "failed with"),
        (FakeHeadset(refuses_push="couldn't write: No space left on device"), "No space left on device"),
        (FakeHeadset(loses_tail=True), "is its storage full?"),
        (FakeHeadset(renames=False), "hero.muaavatar has 14 bytes, expected"),
    ],
)
def test_leaves_nothing_half_pushed(deploy: Deploy, hero: Path, headset: FakeHeadset, sentence: str) -> None:
    headset.files[HERO] = b"the one before"
    message = deploy([headset], hero).sentence
    assert "2G0YC1: " in message
    assert sentence in message
    assert headset.files == {HERO: b"the one before"}
    assert headset.started == []


def test_a_headset_that_vanishes_while_pushed_to_keeps_no_half_avatar(deploy: Deploy, hero: Path) -> None:
    headset = FakeHeadset(cut_after=1, gone_after_cut=True)
    assert "2G0YC1: pushing" in deploy([headset], hero).sentence
    assert HERO not in headset.files


def test_says_that_the_player_does_not_start(deploy: Deploy) -> None:
    headset = FakeHeadset(start_answer="Error type 3\nError: Activity class does not exist.")
    message = deploy([headset]).sentence
    assert "starting com.mua.player failed" in message
    assert "does not exist" in message


def test_self_test_passes(deploy: Deploy) -> None:
    headset = FakeHeadset(player=passing)
    assert "3 of 3 cases passed" in deploy([headset], "--self-test").out
    assert headset.started[0][0] == "-muaSelfTest"
    assert not headset.worn


def idle(arguments: list[str]) -> Iterator[str]:
    """The log goes on without lines of the player."""
    for _ in range(10):
        time.sleep(0.1)
        yield vrapi()


def crash(arguments: list[str]) -> list[str]:
    lines = ("FATAL EXCEPTION: main", f"Process: {PACKAGE}, PID: 1", "java.lang.UnsatisfiedLinkError: openxr")
    return [f"11-21 12:00:00.000 E/AndroidRuntime( 4242): {line}" for line in lines]


@pytest.mark.parametrize(
    ("headset", "sentence"),
    [
        (
            FakeHeadset(player=failing),
            "1 of 2 cases failed on 2G0YC1, the first is mlp_matmul/odd: differs by 0.5 at 7: 1.0",
        ),
        (FakeHeadset(log=passing(["-muaRun", "00000000"]), keeps_log=True), "nothing came from the player in time"),
        (FakeHeadset(player=idle), "nothing came from the player in time"),
        (FakeHeadset(player=lambda a: passing(a)[:-1], log_ends=True), "the log ended before the player was done"),
        (FakeHeadset(player=crash), "crashed: java.lang.UnsatisfiedLinkError"),
    ],
    ids=["a failed case", "an earlier run", "a log that goes on", "the log ended", "a crash"],
)
def test_self_test_says_what_went_wrong(
    deploy: Deploy, monkeypatch: pytest.MonkeyPatch, headset: FakeHeadset, sentence: str
) -> None:
    if "in time" in sentence:
        monkeypatch.setattr(player, "PATIENCE", 0.2)
    assert sentence in deploy([headset], "--self-test").sentence
    assert not headset.worn


def test_bench_measures_at_steady_clocks_and_puts_them_back(deploy: Deploy, hero: Path, tmp_path: Path) -> None:
    during: dict[str, str] = {}

    def look(arguments: list[str]) -> list[str]:
        during.update(headset.properties, worn=str(headset.worn))
        return playing(arguments)

    headset = FakeHeadset(player=look)
    shown = deploy([headset], hero, "--bench", "5", "--json", tmp_path / "bench.json").out
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
    assert "hero on Quest 3, 5 of 5 seconds at 72 Hz" in shown
    assert "app ms" in shown


def test_bench_asks_for_the_rate_and_waits_as_long_as_it_plays(monkeypatch: pytest.MonkeyPatch) -> None:
    waits: list[float] = []
    settings: dict[str, str] = {}

    def follow(*_: object, patience: float) -> Iterator[str]:
        waits.append(patience)
        yield from ()

    def run(verb: str, name: str, value: str = "", *_: str, seconds: float = 0) -> str:
        if verb == "setprop" and value:
            settings[name] = value
        return settings.get(name, "")

    monkeypatch.setattr(bench, "follow", follow)
    headset: Any = SimpleNamespace(serial="2G0YC1", run=run)
    with pytest.raises(InputError, match="the player's log ended"):
        bench.bench(headset, "hero", seconds=4000, rate=90)
    assert waits[0] > 4000
    assert settings["debug.oculus.refreshRate"] == "90"


def test_bench_has_the_rate_and_the_seconds_asked_for(deploy: Deploy, hero: Path, tmp_path: Path) -> None:
    during: dict[str, str] = {}

    def look(arguments: list[str]) -> list[str]:
        during.update(headset.properties)
        return playing(arguments)

    headset = FakeHeadset(player=look)
    ended = deploy([headset], hero, "--bench", "4", "--rate", "90", "--json", tmp_path / "bench.json")
    (benched,) = json.loads((tmp_path / "bench.json").read_text())["benched"]
    assert (benched["rate"], benched["seconds"], len(benched["samples"])) == (90, 4, 4)
    assert during["debug.oculus.refreshRate"] == "90"
    assert "4 of 4 seconds at 90 Hz" in ended.out


def test_bench_puts_the_headset_back_after_an_error(deploy: Deploy, hero: Path, tmp_path: Path) -> None:
    headset = FakeHeadset(player=lambda a: [unity(f"MUA-BENCH {run_of(a)} FAIL avatars/hero.muaavatar: crc32")])
    message = deploy([headset], hero, "--bench", "5", "--json", tmp_path / "bench.json").sentence
    assert "the player cannot measure: avatars/hero.muaavatar: crc32" in message
    assert headset.properties["debug.oculus.gpuLevel"] == "2"
    assert not headset.worn
    assert not (tmp_path / "bench.json").exists()


def test_bench_puts_the_headset_back_where_a_setting_is_refused(deploy: Deploy, hero: Path) -> None:
    headset = FakeHeadset(frozen=frozenset({"debug.oculus.refreshRate"}))
    assert "debug.oculus.refreshRate is '' after setting it" in deploy([headset], hero, "--bench", "5").sentence
    assert headset.properties["debug.oculus.gpuLevel"] == "2"
    assert headset.started == []


def test_bench_says_that_a_lost_headset_keeps_its_settings(deploy: Deploy, hero: Path) -> None:
    def unplug(arguments: list[str]) -> list[str]:
        headset.state, headset.log_ends = "offline", True
        return []

    headset = FakeHeadset(player=unplug)
    message = deploy([headset], hero, "--bench", "5").sentence
    assert "2G0YC1: " in message
    assert "keeps its measuring settings until it is restarted" in message


@pytest.mark.skipif(os.name == "nt", reason="Ctrl-C is sent to one process by POSIX signals only")
def test_bench_puts_the_headset_back_after_ctrl_c(monkeypatch: pytest.MonkeyPatch, hero: Path) -> None:
    headset = FakeHeadset()
    with serving(monkeypatch, headset):
        command = [sys.executable, "-c", HEAR_CTRL_C, str(hero), "--bench", "60"]
        with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE) as deploying:
            until = time.monotonic() + 60
            while not headset.started and time.monotonic() < until:
                time.sleep(0.02)
            assert headset.properties["debug.oculus.gpuLevel"] == "4"
            deploying.send_signal(signal.SIGINT)
            try:
                _, error = deploying.communicate(timeout=30)
            finally:
                deploying.kill()  # has no effect on one that ended
    assert deploying.returncode != 0
    assert b"Traceback" not in error
    assert headset.properties["debug.oculus.gpuLevel"] == "2"
    assert not headset.worn
