"""The doctor names what is missing and its fix, and never fails itself."""

from pathlib import Path

import pytest
from fake_adb import serving
from fake_headset import FakeHeadset
from synthetic_avatar import synthetic_avatar
from test_deploy_build import fake_unity

from mua.asset import write
from mua.deploy.doctor import Check, examine, openxr_runtime

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
