"""The package's self-test, run by mono over stand-ins that read back what its recording makes on Vulkan."""

import json
import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import gen_golden
import pytest
from csharp import PROGRAMS, ROOT, RUNTIME, CSharp, by_name
from fault import Fault
from golden import read_golden
from mutations import FAULTS
from replay import replay
from synthetic_avatar import synthetic_avatar

from mua.asset import write
from mua.deploy import bench, self_test
from mua.deploy.player import answers
from mua.errors import InputError
from mua.gpu import Device

KERNELS = ROOT / "ComputeShaders"
RUN = "0123abcd"
SELF_TEST = ("-muaSelfTest", "-muaRun", RUN)
CASES = len(read_golden())
SECONDS, RATE = 3, 72  # a bench's length, and frames a second of the program's player loop
BENCH = ("-muaBench", "first", "-muaSeconds", str(SECONDS), "-muaRun", RUN)
VRAPI = "I/VrApi (1): FPS=72/72,Stale=0,App=4.5ms"
CAUGHT = {  # by kernel, a fault that its golden cases show
    "mlp_matmul": "ReLU lost",
    "blend_subbands": "LL reads the first coefficients",
    "inverse_dwt": "swapped bands",
    "dq_skinning": "sign against the wrong joint",
    "expressions": "thickness lost",
    "splat_project": "key inverted",
    "splat_sort": "unstable split",
}


@dataclass(frozen=True)
class Ran:
    """What the program printed: values by name, messages of the log by kind."""

    reports: dict[str, list[str]]

    @property
    def cases(self) -> list[self_test.Case]:
        """As mua-deploy reads them from the log."""
        return self_test.collect(answers(self.reports["Log"], self_test.MARK, RUN))

    @property
    def failed(self) -> dict[str, str]:
        return {f"{case.kernel}/{case.name}": case.what for case in self.cases if case.what is not None}


Story = Callable[..., Ran]


@pytest.fixture(scope="module")
def program(csharp: CSharp) -> Path:
    program = PROGRAMS / "SelfTestProgram.cs"
    return csharp.runtime(RUNTIME / "SelfTest", PROGRAMS / "shared", program, name="SelfTestProgram")


@pytest.fixture
def streaming(tmp_path: Path) -> Path:
    """StreamingAssets of a player, and its files beside them: avatars of a bench."""
    folder = tmp_path / "streaming"
    shutil.copytree(gen_golden.GOLDEN, folder / "MuaGolden", ignore=shutil.ignore_patterns("*.md"))
    (folder / "avatars").mkdir()
    write(folder / "avatars" / "first.muaavatar", synthetic_avatar(1), storage="f16")
    write(folder / "avatars" / "second.muaavatar", synthetic_avatar(2), storage="f16")
    (folder / "avatars" / "damaged.muaavatar").write_bytes(b"damaged")
    return folder


@pytest.fixture
def story(csharp: CSharp, program: Path, streaming: Path) -> Story:
    def tell(
        name: str = "Plays", *words: str, kernels: Path = KERNELS, recording: object = "-", answered: object = "-"
    ) -> Ran:
        printed = csharp.run(program, kernels, streaming, recording, answered, name, *(words or SELF_TEST))
        reports = {"Log": [], **by_name(printed)}
        assert (reports["alive"], reports["requests"]) == (["0"], ["0"]), reports
        return Ran(reports)

    return tell


def answer(device: Device, recording: Path) -> Path:
    """The folder of what the buffers hold that a recorded run read."""
    folder = recording.parent / "answers"
    folder.mkdir()
    for label, words in replay(device, recording).kept.items():
        (folder / f"{label}.bin").write_bytes(words.tobytes())
    return folder


@pytest.mark.parametrize("name", ["Plays", "PlaysOnLoad", "PlaysFromPackage"])
def test_every_case_passes(device: Device, story: Story, tmp_path: Path, name: str) -> None:
    recording = tmp_path / "recorded"
    story(name, recording=recording)
    ran = story(name, answered=answer(device, recording))
    assert ran.failed == {}
    assert len(ran.cases) == CASES
    assert ran.reports["Log"][-1] == f"MUA-SELFTEST {RUN} PASS {CASES}/{CASES}"
    assert ran.reports["exit"] == ["0"]


@pytest.mark.parametrize("kernel", CAUGHT)
def test_a_fault_of_a_kernel_fails_its_cases(
    device: Device, story: Story, tmp_path: Path, kernel: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    fault: Fault = next(fault for fault in FAULTS[kernel] if fault.breaks == CAUGHT[kernel])
    shaders = shutil.copytree(KERNELS, tmp_path / "shaders")
    broken = shaders / (fault.file or f"{kernel}.compute")
    broken.write_text(broken.read_text().replace(fault.original, fault.replacement))
    monkeypatch.setenv("MUA_SHADERS", str(shaders))
    recording = tmp_path / "recorded"
    story(recording=recording)
    ran = story(answered=answer(device, recording))
    assert {name.split("/")[0] for name in ran.failed} == {kernel}
    assert all("wanted" in what for what in ran.failed.values())
    assert ran.reports["exit"] == ["1"]


def test_the_device_is_described_and_each_case_named_by_entry_point_and_content(story: Story) -> None:
    ran = story()
    described = ran.reports["Log"][0]
    assert described.startswith("MUA device: stand-in; ")
    assert "Vulkan" in described
    names = [f"{case.kernel}/{case.name}" for case in ran.cases]
    assert len(set(names)) == CASES
    assert {"mlp_matmul/MlpMatmul-f16-ReLU", "inverse_dwt/InverseDwt-bior4.4"} < set(names)
    assert {case.kernel for case in ran.cases} == set(gen_golden.CASES)


def test_a_buffer_that_cannot_be_read_fails_its_case(story: Story) -> None:
    failed = story("IsBroken").failed
    assert len(failed) == CASES
    assert {"read back" in what for what in failed.values()} == {True}


def test_a_device_without_compute_fails_once(story: Story) -> None:
    assert story("LacksCompute").failed == {"device/compute": "stand-in (Vulkan) does not support compute shaders"}


def test_a_package_without_resources_fails_once(story: Story) -> None:
    assert list(story("LacksResources").failed) == ["device/resources"]


def test_a_kernel_that_is_missing_fails_its_cases(story: Story) -> None:
    failed = story("LacksKernel").failed
    missing = {what for name, what in failed.items() if name.startswith("splat_sort/")}
    assert missing == {
        "splat_sort.compute is missing from AvatarResources; reimport the packages com.mua.kernels and com.mua.avatar."
    }


@pytest.mark.parametrize("name", ["Plays", "PlaysFromPackage"])
def test_a_golden_file_that_is_missing_fails_once(story: Story, streaming: Path, name: str) -> None:
    (streaming / "MuaGolden" / "dq_skinning.bin").unlink()
    (streaming / "MuaGolden" / "splat_sort.json").unlink()
    ran = story(name)
    assert {case for case in ran.failed if case.endswith("/golden")} == {"dq_skinning/golden", "splat_sort/golden"}
    assert "dq_skinning.bin" in ran.failed["dq_skinning/golden"]
    assert {case.kernel for case in ran.cases} == set(gen_golden.CASES)


def damage(document: dict[str, Any], *keys: str | int, value: object) -> None:
    """Put a value where the keys lead."""
    place: Any = document
    for key in keys[:-1]:
        place = place[key]
    place[keys[-1]] = value


@pytest.mark.parametrize(
    ("keys", "value", "reported"),
    [
        (("kernel",), "another.compute", "holds no cases of splat_sort.compute"),
        (("cases",), [], "holds no cases"),
        (("cases", 0, "entry"), "", "its entry is not as"),
        (("cases", 0, "groups"), [1, 0, 1], "its groups is not as"),
        (("cases", 0, "groups"), [1, 1 << 16, 1], "its groups is not as"),
        (("cases", 0, "constants", 0, "values"), [], "its constant second_pass is not as"),
        (("cases", 0, "constants", 0, "scalar"), "bool", "its constant second_pass is not as"),
        (("cases", 0, "buffers", 0, "element"), "uint3", "its buffer keys is not as"),
        (("cases", 0, "buffers", 0, "count"), 0, "its buffer keys is not as"),
        (("cases", 0, "buffers", 0, "count"), 2**31 - 1, "its buffer keys is not as"),
        (("cases", 0, "buffers", 0, "offset"), -4, "its buffer keys is not as"),
        (("cases", 0, "buffers", 0, "offset"), 2, "its buffer keys is not as"),
        (("cases", 0, "expected"), [], "its expected is not as"),
        (("cases", 0, "expected", 0, "buffer"), "nowhere", "its expected nowhere is not as"),
        (("cases", 0, "expected", 0, "kind"), "double", "is not as"),
        (("cases", 0, "expected", 0, "first"), 2**31 - 1, "is not as"),
        (("cases", 0, "expected", 0, "period"), 0, "is not as"),
        (("cases", 0, "expected", 0, "offset"), 2**31 - 4, "is not as"),
    ],
)
def test_a_damaged_golden_file_fails_once(
    story: Story, streaming: Path, keys: tuple[str | int, ...], value: object, reported: str
) -> None:
    path = streaming / "MuaGolden" / "splat_sort.json"
    document = json.loads(path.read_text())
    damage(document, *keys, value=value)
    path.write_text(json.dumps(document))
    assert reported in story().failed["splat_sort/golden"]


@pytest.mark.parametrize("beyond", [0, 1])
def test_expected_values_lie_within_their_buffer_to_its_last_word(story: Story, streaming: Path, beyond: int) -> None:
    path = streaming / "MuaGolden" / "splat_sort.json"
    document = json.loads(path.read_text())
    case, expected = next(
        (case, each)
        for case in document["cases"]
        for each in case["expected"]
        if each["length"] == each["period"] and each["kind"] == "uint"
    )
    held = next(buffer for buffer in case["buffers"] if buffer["name"] == expected["buffer"])
    words = held["count"] * (4 if held["element"].endswith("4") else 2 if held["element"].endswith("2") else 1)
    expected["first"] = words - expected["count"] + beyond
    path.write_text(json.dumps(document))
    refused = f"its expected {held['name']} is not as" in story().failed.get("splat_sort/golden", "")
    assert refused == bool(beyond)


def test_a_golden_file_that_is_cut_fails_once(story: Story, streaming: Path) -> None:
    for name in ("mlp_matmul.json", "splat_sort.bin"):
        path = streaming / "MuaGolden" / name
        path.write_bytes(path.read_bytes()[:-8])
    failed = story().failed
    assert "mlp_matmul.json is no JSON" in failed["mlp_matmul/golden"]
    assert "bytes of .bin" in failed["splat_sort/golden"]


def test_a_player_without_arguments_tests_nothing(story: Story) -> None:
    assert story("Plays", "-another").reports["Log"] == []


@pytest.mark.parametrize("name", ["Plays", "HasScene"])
def test_a_bench_says_when_samples_count(story: Story, name: str) -> None:
    ran = story(name, *BENCH)
    lines = [line for reports in ran.reports["Log"] for line in (VRAPI, reports)]
    assert len(bench.collect(lines, RUN)) == 1
    assert ran.reports["Log"][-2:] == [f"MUA-BENCH {RUN} START first", f"MUA-BENCH {RUN} END"]
    assert (ran.reports["over"], ran.reports["exit"]) == (["True"], ["0"])


def test_a_bench_measures_every_frame(story: Story, streaming: Path) -> None:
    story("IsTimed", *BENCH)
    report = json.loads((streaming / "bench.json").read_text())
    assert report["avatar"] == "first"
    assert abs(len(report["frames"]) - SECONDS * RATE) <= 1
    assert report["frames"] == pytest.approx([1000 / RATE] * len(report["frames"]), rel=1e-3)
    assert set(report["gpu"]) == {4.5}
    assert [stage["name"] for stage in report["stages"]] == ["MUA sort"]
    assert set(report["stages"][0]["gpu"]) == {2}


def test_a_bench_whose_report_cannot_be_written_says_so_and_ends(story: Story) -> None:
    ran = story("CannotWrite", *BENCH)
    assert (ran.reports["over"], ran.reports["exit"]) == (["True"], ["0"])
    [warned] = ran.reports["Warning"]
    assert "bench.json could not be written: " in warned


def test_a_device_without_timings_leaves_them_out(story: Story, streaming: Path) -> None:
    story("Plays", *BENCH)
    report = json.loads((streaming / "bench.json").read_text())
    assert (report["gpu"], report["stages"]) == ([], [])


def test_a_bench_takes_the_avatar_of_the_scene_alone(story: Story) -> None:
    ran = story("HasScene", *BENCH)
    assert ran.reports["shown"] == ["2"]
    assert ran.reports["on"] == ["True False 1"]


@pytest.mark.parametrize("name", ["Plays", "LooksDown"])
def test_a_bench_has_the_avatar_before_the_camera(story: Story, name: str) -> None:
    middle = [float(word) for word in story(name, *BENCH).reports["middle"][0].split()]
    assert middle == pytest.approx([0, 0, 2], abs=0.3)  # the clip moves it


def failure(ran: Ran) -> str:
    """What mua-deploy tells of a bench that failed."""
    assert (ran.reports["over"], ran.reports["exit"]) == (["True"], ["1"])
    with pytest.raises(InputError) as raised:
        bench.collect(ran.reports["Log"], RUN)
    return str(raised.value)


@pytest.mark.parametrize("seconds", ["0", "-1", "nan", "1e9", "soon"])
def test_a_bench_of_no_time_fails(story: Story, seconds: str) -> None:
    reported = failure(story("Plays", "-muaBench", "first", "-muaSeconds", seconds, "-muaRun", RUN))
    assert f"-muaSeconds is {seconds}, expected a number" in reported


def test_a_bench_without_seconds_fails(story: Story) -> None:
    assert "-muaSeconds is missing" in failure(story("Plays", "-muaBench", "first", "-muaRun", RUN))


@pytest.mark.parametrize("avatar", ["nowhere", "damaged"])
def test_a_bench_of_no_avatar_fails(story: Story, avatar: str) -> None:
    assert "cannot measure: " in failure(story("Plays", "-muaBench", avatar, *BENCH[2:]))


def test_a_bench_fails_that_loses_its_avatar(story: Story) -> None:
    reported = failure(story("LosesAvatar", "-muaBench", "first", "-muaSeconds", "60", "-muaRun", RUN))
    assert reported == "the player cannot measure: the scene has destroyed the avatar first"
