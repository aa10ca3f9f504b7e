"""The doctor names what is missing and its fix, and never fails itself."""

import re
from pathlib import Path

import pytest
from commands import Commands
from fake_adb import serving
from fake_headset import FakeHeadset
from fake_unity import fake_unity
from synthetic_avatar import synthetic_avatar

from mua.asset import write
from mua.deploy.doctor import Check, examine, openxr_runtime

PLAYER_SETTINGS = Path(__file__).parents[2] / "unity-package" / "Editor" / "ProjectPlayer.cs"
# adbutils leaves a socket open where a device refuses.
pytestmark = pytest.mark.filterwarnings("ignore:unclosed <socket:ResourceWarning")


def states(checks: list[Check]) -> dict[str, str]:
    assert all(bool(check.fix) == (check.state != "ok") for check in checks)
    return {check.name: check.state for check in checks}


def test_all_is_well(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    hero = tmp_path / "hero.muaavatar"
    write(hero, synthetic_avatar())
    with serving(monkeypatch, FakeHeadset()):
        found = states(examine([hero], unity=fake_unity(tmp_path, "exit 0")))
    names = ("adb", "adb server", "headset", "system", "battery", "player", "Unity", "Android module", "hero.muaavatar")
    assert found == dict.fromkeys(names, "ok")


def test_names_what_is_wrong(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    (tmp_path / "bad.muaavatar").write_bytes(b"no")
    headset = FakeHeadset(packages=set(), battery="7")
    headset.properties["ro.build.version.sdk"] = "28"
    unity = fake_unity(tmp_path, "exit 0", version="2022.3.1f1")
    with serving(monkeypatch, headset):
        found = states(examine([tmp_path / "bad.muaavatar", tmp_path / "absent.muaavatar"], unity=unity))
    wrong = {"system", "battery", "Unity", "bad.muaavatar"}
    assert {name for name, state in found.items() if state == "wrong"} == wrong
    assert {name for name, state in found.items() if state == "missing"} == {"player", "absent.muaavatar"}


@pytest.mark.parametrize(("older", "state"), [(0, "ok"), (1, "wrong")])
def test_a_headset_needs_the_android_that_the_player_is_built_for(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, older: int, state: str
) -> None:
    set_up = re.search(r"Oldest = AndroidSdkVersions\.AndroidApiLevel(\d+);", PLAYER_SETTINGS.read_text())
    assert set_up is not None
    headset = FakeHeadset()
    headset.properties["ro.build.version.sdk"] = str(int(set_up[1]) - older)
    with serving(monkeypatch, headset):
        assert states(examine([], unity=fake_unity(tmp_path, "exit 0")))["system"] == state


@pytest.mark.parametrize(
    ("headsets", "state"),
    [([], "missing"), ([FakeHeadset(state="offline")], "wrong"), ([FakeHeadset("A"), FakeHeadset("B")], "wrong")],
)
def test_looks_into_no_headset_that_is_not_ready(
    monkeypatch: pytest.MonkeyPatch, headsets: list[FakeHeadset], state: str
) -> None:
    with serving(monkeypatch, *headsets):
        found = states(examine([], unity=Path("/absent")))
    assert (found["headset"], found["Unity"]) == (state, "missing")
    assert "battery" not in found


def test_pc_link_wants_metas_runtime() -> None:
    assert openxr_runtime("C:\\Program Files\\Oculus\\Support\\oculus-runtime\\oculus_openxr_64.json").state == "ok"
    assert openxr_runtime("C:\\Steam\\steamxr_win64.json").state == "wrong"
    assert openxr_runtime(None).state == "missing"


def test_the_command_shows_every_check_and_names_those_that_are_not_ok(
    command: Commands, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    hero, headset = tmp_path / "hero.muaavatar", FakeHeadset()
    write(hero, synthetic_avatar())
    unity = fake_unity(tmp_path, "exit 0")
    with serving(monkeypatch, headset):
        ended = command("deploy", "--doctor", "--unity", unity, hero)
        assert ended.status == 0, ended.err
        assert ended.out.count(" ok ") == len(examine([hero], unity=unity))
    with serving(monkeypatch, FakeHeadset(battery="7", packages=set())):
        ended = command("deploy", "--doctor", "--unity", unity, hero)
    assert "2 of 9 checks are not ok: battery, player" in ended.sentence
    assert "bake it anew" not in ended.out
    assert "hero.muaavatar" in ended.out
