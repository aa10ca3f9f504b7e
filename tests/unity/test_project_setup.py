"""Set-up of a project in stand-ins of the editor: what it changes, what it leaves alone, and what it says."""

import re

import pytest
from csharp import CSharp
from package_compiler import assemblies
from project_program import ProjectProgram

XR = "com.unity.xr.management com.unity.xr.openxr"
URP = "com.unity.render-pipelines.universal"
PLATFORMS = {"Quest": "Android", "PcLink": "Standalone"}
BOTH = {  # in a project with URP and OpenXR, whose every setting was another
    "Player > Color space": "Linear",
    "Player > Auto graphics API for {}": "off",
    "Graphics > Render pipeline": "UniversalRenderPipelineAsset",
    "Graphics > Compatibility mode": "off",
    "XR > Loader for {}": "UnityEngine.XR.OpenXR.OpenXRLoader",
    "XR > Initialize XR on startup for {}": "on",
    "OpenXR > Render mode for {}": "SinglePassInstanced",
    "OpenXR > com.unity.openxr.feature.input.oculustouch for {}": "on",
    "OpenXR > com.unity.openxr.feature.input.metaquestplus for {}": "on",
}
AUTO = "Player > Auto graphics API for Standalone"
MADE = {
    "Quest": {
        **{name.format("Android"): value for name, value in BOTH.items()},
        "Player > Scripting backend": "IL2CPP",
        "Player > IL2CPP code generation": "OptimizeSpeed",
        "Player > Managed stripping level": "Low",
        "Player > Package name": "com.mua.player",
        "Player > Target architectures": "ARM64",
        "Player > Minimum API level": "AndroidApiLevel32",
        "Player > Target API level": "AndroidApiLevel34",
        "Player > Application entry point": "GameActivity",
        "Player > Default orientation": "LandscapeLeft",
        "Player > Graphics APIs for Android": "Vulkan",
        "Player > Multithreaded rendering": "on",
        "Player > Apply display rotation during rendering": "off",
        "Player > Texture compression formats": "ASTC",
        "Build > Texture compression": "ASTC",
        "Pipeline > HDR": "off",
        "Pipeline > MSAA": "1",
        "Pipeline > Opaque texture": "off",
        "Pipeline > Depth texture": "off",
        "OpenXR > com.unity.openxr.feature.metaquest for Android": "on",
        # the edges of the view are drawn coarser: what the player asks of the display does nothing before both are set
        "OpenXR > com.unity.openxr.feature.foveatedrendering for Android": "on",
        "OpenXR > Foveated rendering API for Android": "SRPFoveation",
        "OpenXR > Late latching for Android": "off",
    },
    "PcLink": {
        **{name.format("Standalone").replace(AUTO, f"{AUTO}Windows64"): value for name, value in BOTH.items()},
        "Player > Graphics APIs for StandaloneWindows64": "Direct3D11, Direct3D12",
        "Player > Run in background": "on",
    },
}
SAVED = {  # kinds of what set-up changes, as the editor keeps only what is marked
    "Quest": "Feature MetaQuestFeature OpenXRSettings UniversalRenderPipelineAsset XRGeneralSettings",
    "PcLink": "Feature OpenXRSettings XRGeneralSettings",
}
FAULT = re.compile(r"(.+?) is (.+), expected (.+)")
CHANGE = re.compile(r"Log MUA set (.+?): (.+) -> (.+)")


@pytest.fixture(scope="module")
def program(csharp: CSharp) -> ProjectProgram:
    return ProjectProgram(csharp)


@pytest.mark.parametrize("platform", PLATFORMS)
def test_a_new_project_is_made_right_once(program: ProjectProgram, platform: str) -> None:
    reported = program.tell("SetsUp", platform)
    changes = [CHANGE.fullmatch(line) for line in reported["log"]]
    assert all(changes)
    assert sorted((change[1], change[3]) for change in changes if change) == sorted(MADE[platform].items())
    assert all(map(FAULT.fullmatch, reported["before"]))
    assert "after" not in reported
    assert reported["saved"] == [
        SAVED[platform] + " XRGeneralSettingsPerBuildTarget"
    ]  # else the editor forgets what was set when it is closed
    assert (reported["changed again"], reported["dirtied again"]) == (["0"], ["0"])
    assert "again" not in reported


def test_a_renderer_that_is_made_can_draw_camera_effects(program: ProjectProgram) -> None:
    """Bloom and tone mapping, whose shaders a renderer is not given by CreateInstance."""
    [path] = program.tell("MakesRenderer")["effects"]
    assert path.endswith("/PostProcessData.asset")


def test_the_built_in_pipeline_keeps_the_one_way_that_it_knows(program: ProjectProgram) -> None:
    reported = program.tell("KeepsBuiltIn")
    assert "after" not in reported
    assert reported["api"] == ["Legacy"]
    assert "Log MUA set Quality > Anti-aliasing: 4 -> 0" in reported["log"]  # the most that any quality level has


def test_an_openxr_that_fails_builds_is_too_old() -> None:
    """1.12 does, where the old input handler is active."""
    definition = assemblies()["Mua.Avatar.Editor"].definition
    (rule,) = [rule for rule in definition["versionDefines"] if rule["define"] == "MUA_OPENXR"]
    assert tuple(map(int, rule["expression"].split("."))) >= (1, 13)


def test_xr_settings_that_the_editor_lost_are_taken_and_an_optional_feature_enabled(program: ProjectProgram) -> None:
    reported = program.tell("FindsLostSettings")
    assert (reported["found"], "after" in reported) == (["True"], False)
    assert (
        "Log MUA set OpenXR > com.unity.openxr.feature.meta-display-utilities for Android: off -> on" in reported["log"]
    )


@pytest.mark.parametrize("platform", PLATFORMS)
def test_each_setting_that_is_broken_is_named_and_mended(program: ProjectProgram, platform: str) -> None:
    reported = program.tell("NamesWhatIsBroken", platform)
    faults = [FAULT.fullmatch(line) for line in reported["fault"]]
    assert {fault[1] for fault in faults if fault} == set(MADE[platform])
    assert set(reported["left"]) == {"0"}


@pytest.mark.parametrize(
    ("own", "pipeline"),
    [("nothing", "own"), ("Assets/Skin.mat", "built-in"), ("Assets/Samples/MUA Avatar/A.mat", "own")],
)
def test_what_is_right_another_way_is_left_alone(program: ProjectProgram, own: str, pipeline: str) -> None:
    reported = program.tell("KeepsWhatIsRight", own)
    assert "after" not in reported
    assert reported["identifier"] == ["org.example.own"]
    assert reported["sdk"] == ["AndroidApiLevel33 AndroidApiLevel35"]
    assert reported["stripping"] == ["Minimal"]
    assert reported["pipeline"] == [
        pipeline
    ]  # a project with materials of its own keeps the pipeline that they are for


def test_another_render_pipeline_is_named_and_kept(program: ProjectProgram) -> None:
    reported = program.tell("KeepsWhatIsRight", "pipeline")
    assert reported["after"] == ["Graphics > Render pipeline is OtherPipeline, expected UniversalRenderPipelineAsset"]


def test_an_editor_without_the_module_is_told_how_to_get_it(program: ProjectProgram) -> None:
    reported = program.tell("LacksModule")
    assert reported["fault"] == ["This editor cannot build for Quest: add 'Android Build Support' with Unity Hub"]
    assert reported["exit"] == ["exit 1"]
    assert reported["log"] == [
        "Error MUA-BUILD FAIL This editor cannot build for PC Link: add 'Windows Build Support' with Unity Hub",
        "Error MUA-BUILD FAIL This editor cannot build for Quest: add 'Android Build Support' with Unity Hub",
    ]


def test_the_menu_switches_the_platform_and_batch_mode_asks_for_it(program: ProjectProgram) -> None:
    menu = program.tell("HasOtherPlatform", "menu")
    assert (menu["platform"], menu["exit"]) == (["Android"], ["none"])
    assert menu["log"][-1] == "Log MUA: the project is set up for Quest."
    batch = program.tell("HasOtherPlatform", "batch")
    assert (batch["platform"], batch["exit"]) == (["StandaloneLinux64"], ["exit 1"])
    assert batch["log"][-1].endswith("expected Android: start Unity with -buildTarget Android")


def test_the_menu_tells_what_is_wrong_and_changes_nothing(program: ProjectProgram) -> None:
    assert program.tell("Tells")["log"] == [
        "Log MUA: the project is set up for Quest.",
        "Error MUA: Player > Color space is Gamma, expected Linear",
    ]


@pytest.mark.parametrize(("own", "asked"), [("nothing", f"{XR} {URP}"), ("Assets/Skin.mat", XR)])
def test_batch_mode_adds_packages_and_asks_to_be_run_again(program: ProjectProgram, own: str, asked: str) -> None:
    reported = program.tell("LacksPackages", "batch", "no", "", own, packages=False)
    assert (reported["asked"], reported["exit"]) == ([asked], ["exit 3"])
    assert reported["log"] == [f"Log MUA-BUILD AGAIN added {asked.replace(' ', ', ')}"]
    assert "Package com.unity.xr.openxr is absent or too old" in "".join(reported["fault"])


def test_packages_that_cannot_be_added_fail_with_the_reason(program: ProjectProgram) -> None:
    reported = program.tell("LacksPackages", "batch", "no", "no network", "Assets/Skin.mat", packages=False)
    assert reported["exit"] == ["exit 1"]
    assert reported["log"] == [f"Error MUA-BUILD FAIL Packages {XR.replace(' ', ', ')} could not be added: no network"]


def test_the_menu_asks_before_it_adds_packages(program: ProjectProgram) -> None:
    refused = program.tell("LacksPackages", "menu", "no", "", "nothing", packages=False)
    assert (refused["asked"], refused["exit"], refused["resumes"]) == ([""], ["none"], ["0"])
    assert len(refused["log"]) == 3
    assert all("install it by name in the Package Manager" in line for line in refused["log"])
    agreed = program.tell("LacksPackages", "menu", "yes", "", "nothing", packages=False)
    assert (agreed["asked"], agreed["resumes"]) == ([f"{XR} {URP}"], ["0"])
    assert "log" not in agreed
    failed = program.tell("LacksPackages", "menu", "yes", "no network", "nothing", packages=False)
    assert failed["log"][0].endswith("could not be added: no network")


def test_the_menu_goes_on_once_packages_are_there(program: ProjectProgram) -> None:
    reported = program.tell("GoesOnAfterReload")
    assert "fault" not in reported
    assert reported["resumes"] == ["0"]
