"""AvatarRenderer in a player loop of stand-ins: what it shows, what it says, what it gives back."""

import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from csharp import PROGRAMS, ROOT, RUNTIME, CSharp
from synthetic_avatar import synthetic_avatar, with_surface
from training import outside_of_training

from mua.asset import write
from mua.model import Layer
from mua.pose.resample import resample

sys.path.append(str(ROOT / "tests" / "parity"))

from test_frame import FEWER_THAN, FRAME_ORDER

STAND_INS = Path(__file__).parent / "stand_ins"
KERNELS = ROOT / "ComputeShaders"
WIDE = 1500  # a layer that needs more than one frame's chunk
SECOND = 72  # frames of the program's player loop
RATE = 24  # of the synthetic avatars
TURNED, TRANSLATED = 1e-6, 1e-5  # float32 of a few transforms on top of each other
Told = dict[str, list[str]]
Story = Callable[..., Told]


@pytest.fixture(scope="module")
def program(csharp: CSharp) -> Path:
    engine = csharp.build([STAND_INS / "UnityEngine"], library=True, name="UnityEngine")
    file = csharp.build([RUNTIME / "Format"], library=True, name="Mua.Format")
    motion = csharp.build([RUNTIME / "Motion"], library=True, name="Mua.Motion", references=[file])
    sources = [
        *sorted(RUNTIME.glob("*.cs")),
        RUNTIME / "Kernels",
        PROGRAMS / "shared",
        PROGRAMS / "ComponentProgram.cs",
        PROGRAMS / "ComponentLevels.cs",
        PROGRAMS / "ComponentLife.cs",
        PROGRAMS / "ComponentRig.cs",
        PROGRAMS / "ComponentSteering.cs",
    ]
    return csharp.build(sources, name="ComponentProgram", references=[engine, file, motion])


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two avatars, one that takes several frames to upload, and one that is damaged."""
    made = tmp_path_factory.mktemp("avatars")
    avatar = with_surface(synthetic_avatar(1))
    write(made / "first.muaavatar", avatar, storage="f16")
    write(made / "second.muaavatar", synthetic_avatar(2), storage="i8")
    first, *_, last = avatar.coarse.mlp
    outputs, inputs = len(last.bias), first.weight.shape[1]
    zeros = [np.zeros(shape, np.float32) for shape in ((WIDE, inputs), (WIDE, WIDE), (outputs, WIDE))]
    mlp = tuple(Layer(weight, np.zeros(len(weight), np.float32)) for weight in zeros)
    write(made / "wide.muaavatar", replace(avatar, coarse=replace(avatar.coarse, mlp=mlp)), storage="f32")
    content = bytearray((made / "first.muaavatar").read_bytes())
    content[len(content) // 2] ^= 0xFF
    (made / "damaged.muaavatar").write_bytes(content)
    return made


@pytest.fixture
def story(csharp: CSharp, program: Path, folder: Path) -> Story:
    def tell(name: str, *files: str) -> Told:
        told: Told = {"log": []}
        said = csharp.run(program, KERNELS, name, *(folder / f"{file}.muaavatar" for file in files))
        for line in said.splitlines():
            key, value = line.split("\t", 1)
            told.setdefault(key, []).append(value)
        assert (told["alive"], told["requests"], told["world"]) == (["0"], ["0"], ["0"]), told
        return told

    return tell


def test_a_clip_plays(story: Story) -> None:
    told = story("Plays", "first")
    assert told["state"] == ["Ready"]
    assert told["clips"] == [" ".join(clip.name for clip in synthetic_avatar(1).clips)]
    assert told["draws"] == [str(SECOND)]
    assert told["log"] == []


def test_a_component_without_an_avatar_has_nothing_and_takes_nothing(story: Story) -> None:
    told = story("IsPlain")
    assert told["plain"] == ["Empty '' 0 '' 0"]
    assert told["clip"] == ["0 of 0, 0 of 0, 0"]
    assert told["outside"] == ["0"]
    assert told["plays"] == ["True 1, Splats, Shadow, Automatic, True"]
    assert told["bounds"] == ["1 2 3 0"]
    assert told["log"] == []


def test_an_application_chooses_clip_frame_and_speed(story: Story, folder: Path) -> None:
    avatar = synthetic_avatar(1)
    [clip] = avatar.clips
    shorter = replace(clip, name="shorter", rotations=clip.rotations[:4], translations=clip.translations[:4])
    later = replace(clip, name="later", rotations=clip.rotations[4:], translations=clip.translations[4:])
    write(folder / "clips.muaavatar", replace(avatar, clips=(clip, shorter, later)))
    told = story("Steers", "clips")
    counts = [len(resample(each, avatar.encoding.rate)) for each in (clip, shorter, later)]
    assert (told["name"], told["progress"], told["frames"]) == ([avatar.name], ["1"], [str(counts[0])])
    assert told["clip"] == [f"{index} 0 {counts[index]}" for index in (0, 2, 1, 0)]
    assert told["still"] == ["0.25"]
    assert float(told["half"][0]) == pytest.approx(36 / SECOND)
    assert float(told["slow"][0]) == pytest.approx(0.5)
    assert float(told["back"][0]) == pytest.approx(0.5)
    assert told["posed"][0] != told["posed"][1]  # the first poses of two clips, one after the other
    missing = f"the avatar has no clip nobody's; its clips are {clip.name}, shorter, later."
    assert told["picked"] == [f"0 {missing}", "2 "]
    assert [line.rpartition(": ")[2] for line in told["log"]] == [missing]


def test_an_avatar_says_how_far_outside_of_training_its_pose_is(story: Story, folder: Path) -> None:
    told, file = story("LeavesTraining", "first"), folder / "first.muaavatar"
    expected = [outside_of_training(file, frame) for frame in (2, 5, 0)]
    assert min(np.abs(np.diff(expected))) > 0.01
    assert [float(number) for number in told["outside"]] == pytest.approx(expected, rel=1e-6)
    assert told["loading"] == ["0"]


def test_a_load_asks_once_for_the_packages_resources(story: Story) -> None:
    assert story("Plays", "first")["asked"] == ["1"]


def test_an_avatar_is_decoded_at_its_own_rate_and_posed_in_every_frame(story: Story) -> None:
    posed = FRAME_ORDER[FRAME_ORDER.index("BlendVertices") :]
    decodes, rest = divmod(
        int(story("Plays", "first")["dispatches"][0]) - SECOND * len(posed), len(FRAME_ORDER) - len(posed)
    )
    assert rest == 0
    assert abs(decodes - RATE) <= 1
    assert len(FRAME_ORDER) < FEWER_THAN


def test_a_frame_allocates_nothing(story: Story) -> None:
    assert story("Plays", "first")["allocated"] == ["0"]
    assert story("FollowsRig", "first")["allocated"] == ["0"]


def test_a_still_avatar_is_only_sorted(story: Story) -> None:
    told = story("Plays", "first")
    sorting = FRAME_ORDER[FRAME_ORDER.index("SplatProject") :]
    assert told["frame"] == ["3"]
    assert told["idle"] == [str(10 * len(sorting))]


def test_an_avatar_stands_where_its_object_stands(story: Story) -> None:
    assert float(story("Plays", "first")["moved"][0]) == pytest.approx(5, abs=1e-4)


def test_views_are_drawn_in_their_order(story: Story) -> None:
    told = story("ShowsViews", "first")
    assert told["order"] == [
        "Hidden/MUA/Surface 0",
        "Hidden/MUA/Surface 1",
        "Hidden/MUA/Splat 0",
        "Hidden/MUA/Surface 2",
    ]
    assert told["together"] == ["4 1"]  # draws of the camera, draws that wait for lights
    assert told["shadow"] == ["0 1"]
    assert told["nothing"] == ["0 0"]
    assert told["log"] == []


def test_an_avatar_of_two_texels_has_no_geometry_and_shows_the_rest(story: Story, folder: Path) -> None:
    avatar = synthetic_avatar(1)
    texels = avatar.rig.texels
    few = replace(
        texels, texels=texels.texels[:2], triangles=texels.triangles[:2], barycentrics=texels.barycentrics[:2]
    )
    geometry, appearance = (replace(b, static=b.static[:, :2]) for b in (avatar.geometry, avatar.appearance))
    avatar = replace(avatar, rig=replace(avatar.rig, texels=few), geometry=geometry, appearance=appearance)
    write(folder / "sparse.muaavatar", with_surface(avatar), storage="f16")
    told = story("ShowsSparse", "sparse")
    assert told["order"] == ["Hidden/MUA/Surface 1", "Hidden/MUA/Splat 0", "Hidden/MUA/Surface 2"]
    assert told["log"] == []


def test_a_file_without_a_surface_is_told_once_and_shows_the_rest(story: Story, folder: Path) -> None:
    write(folder / "bare.muaavatar", synthetic_avatar(1), storage="f16")
    told = story("ShowsSparse", "bare")
    assert told["order"] == ["Hidden/MUA/Surface 1", "Hidden/MUA/Splat 0", "Hidden/MUA/Surface 2"]
    sentence = "synthetic cannot show its Geometry: the file holds no surface to show; bake it again."
    assert [line.rpartition("MUA: ")[2] for line in told["log"]] == [sentence]


def test_splats_are_drawn_where_surfaces_cannot_be(story: Story) -> None:
    told = story("LacksSurface", "first")
    assert told["together"] == ["1 0"]
    assert len(told["log"]) == 1
    assert "cannot show its Shadow: the surface shader is missing" in told["log"][0]


def test_avatars_come_and_go(story: Story) -> None:
    told = story("Crowd", "first", "second")
    counts = [len(synthetic_avatar(seed).rig.texels.texels) for seed in (1, 2)]
    assert told["both"] == [str(sum(counts))]
    assert told["one"] == [str(counts[0])]
    assert (told["fewer"], told["again"]) == (["1"], ["1"])
    assert told["state"] == ["Ready Ready"]
    assert told["log"] == []


def test_an_avatar_that_rests_is_posed_again_into_the_buffer_that_is_left(story: Story) -> None:
    """Splats of all avatars lie in one, which is another when one of them has gone."""
    told = story("StaysBehind", "first", "second")
    posed = FRAME_ORDER[FRAME_ORDER.index("BlendVertices") :]
    assert told["left"] == [str(len(posed))]
    assert told["idle"] == [str(len(posed) - posed.index("SplatProject"))]


def test_an_avatar_out_of_view_rests_unless_its_shadow_may_be_seen(story: Story) -> None:
    told = story("StandsOutOfView", "first", "second")
    at_rest = len(FRAME_ORDER) - FRAME_ORDER.index("SplatProject")
    assert told["both"] == told["back"] == [str(at_rest + 1)]  # each is projected
    assert int(told["shadow"][0]) == at_rest + FRAME_ORDER.index("SplatProject")  # decoded and posed, not projected
    assert told["one"] == told["far"] == told["without"] == [str(at_rest)]
    assert told["stands"] == ["1"]  # where it would be seen
    assert (told["none"], told["drawn"]) == (["0"], ["0"])
    assert int(told["again"][0]) > at_rest + FRAME_ORDER.index("SplatProject")  # decodes what it missed


def test_an_avatar_destroyed_while_it_uploads_leaves_nothing(story: Story) -> None:
    told = story("GoesMidUpload", "wide")
    assert (told["state"], told["progress"], told["held"]) == (["Loading"], ["1"], ["1"])


def test_an_avatar_destroyed_while_it_is_read_leaves_nothing(story: Story) -> None:
    assert story("GoesMidRead", "first")["log"] == []


def test_a_file_is_found_in_both_folders_and_in_an_asset(story: Story, folder: Path) -> None:
    """Persistent data before what came with the application."""
    (folder / "others").mkdir()
    write(folder / "others" / "first.muaavatar", replace(synthetic_avatar(2), name="another"), storage="f16")
    told = story("FindsFiles", "first")
    assert told["state"] == ["Ready"] * 3
    assert told["of both"] == [synthetic_avatar(1).name]


def test_a_file_inside_an_android_package_is_requested(story: Story) -> None:
    told = story("Streams", "first")
    assert told["state"] == ["Ready", "Failed"]
    assert len(told["log"]) == 1
    assert "404" in told["log"][0]


def test_as_many_buffers_as_a_kernel_and_a_draw_take_are_enough(story: Story) -> None:
    told = story("HasJustEnoughBuffers", "first")
    assert (told["state"], told["log"]) == (["Ready"], [])


@pytest.mark.parametrize(
    ("name", "file", "words"),
    [
        ("Fails", "damaged", "crc32"),
        ("Fails", "absent", "absent.muaavatar"),
        ("FailsInEditor", "damaged", "crc32"),
        ("FailsInEditor", "absent", "absent.muaavatar"),
        ("LacksKernel", "first", "splat_sort.compute"),
        ("LacksResources", "first", "MuaAvatarResources"),
        ("LacksCompute", "first", "compute shaders"),
        ("LacksBuffers", "first", "4 buffers in a compute kernel"),
        ("LacksVertexBuffers", "first", "4 buffers in a vertex shader"),
        ("LacksMemory", "first", "4096"),
    ],
)
def test_what_is_wrong_is_said_once(story: Story, name: str, file: str, words: str) -> None:
    told = story(name, file)
    assert told["state"] == ["Failed"]
    assert told["held"] == ["0"]
    assert len(told["log"]) == 1, told["log"]
    assert told["log"][0].startswith("Error MUA: ")
    assert words in told["log"][0]
    assert "One or more errors" not in told["log"][0]
    assert told["log"][0].endswith(told["message"][0])


def test_an_avatar_that_has_no_room_beside_others_goes_alone(story: Story) -> None:
    told = story("LacksMemoryForTwo", "first")
    assert told["state"] == ["Ready Failed"]
    assert told["shown"] == ["1"]
    assert len(told["log"]) == 1, told["log"]
    assert "splats" in told["message"][0]


def test_a_game_that_starts_without_a_reload_keeps_its_avatars_and_says_anew_what_is_wrong(story: Story) -> None:
    told = story("StartsWithoutReload", "first")
    assert told["draws"] == ["10"]
    assert len(told["log"]) == 2  # once in each game
    assert all("nowhere.muaavatar" in line for line in told["log"])


def test_an_avatar_that_one_eye_sees_is_drawn_for_both(story: Story) -> None:
    told, sorting = story("IsSeenByOneEye", "first"), len(FRAME_ORDER) - FRAME_ORDER.index("SplatProject")
    assert told["seen"] == [f"True {sorting} True", f"True {sorting} True", "False 0 False"]


def test_an_avatar_stands_where_its_parents_carry_it(story: Story) -> None:
    told = story("HasParent", "first")
    before, moved, turned = (np.array(line.split(), float) for line in told["box"])
    np.testing.assert_allclose(moved, np.add(before, [5, 1, 0, 0, 0, 0]), atol=1e-5)
    x, y, z, *_ = before
    np.testing.assert_allclose(turned[:3], [5 + z, 1 + y, -x], atol=1e-5)
    np.testing.assert_allclose(turned[3:], before[[5, 4, 3]], atol=1e-5)
    assert int(told["turned"][0]) == len(FRAME_ORDER) - FRAME_ORDER.index("BlendVertices")
    assert "which avatars ignore" in told["message"][0]  # the parent's scale


def test_one_avatar_takes_the_place_of_another(story: Story) -> None:
    told, first, second = story("ShowsOneAfterAnother", "first", "second"), counts(1)[0], counts(2)[0]
    assert told["shown"] == [
        f"Ready {first} False",
        f"Ready {second} True",
        f"Ready {first} False",
        "Failed 0 False",
        f"Ready {first} False",
        "Empty 0 False",
        f"Ready {second} True",
    ]
    assert told["message"][0].endswith("it is no avatar.")


def test_a_scene_keeps_every_setting_of_a_component(story: Story) -> None:
    assert story("IsCopied", "first")["copy"] == ["Ready 0.5 Mesh Half False True"]


def test_each_avatar_starts_over_where_its_own_clip_ends(story: Story, folder: Path) -> None:
    avatar = synthetic_avatar(2)
    clip = avatar.clips[0]
    short = replace(clip, rotations=clip.rotations[:3], translations=clip.translations[:3])
    write(folder / "short.muaavatar", replace(avatar, clips=(short,)), storage="f16")
    told = story("EndsEarly", "short", "first")
    frames = len(synthetic_avatar(1).clips[0])
    assert told["counts"] == [f"3 {frames}"]
    assert told["frames"] == [f"{at % 3} {at % frames}" for at in (4, 8, 12)]  # 12 displayed frames are 4 of a clip


def test_a_clip_holds_its_last_frame_until_it_starts_over(story: Story) -> None:
    assert story("StaysAtItsEnd", "first")["at"] == ["last", "last", "last", "first", ""]


def test_a_clip_stands_still_in_an_editor_that_does_not_play(story: Story) -> None:
    still, playing = (float(seconds) for seconds in story("StandsStillInEditor", "first")["seconds"])
    assert still == 0.1
    assert playing == pytest.approx(0.1 + 10 / SECOND)


def test_a_joint_that_is_destroyed_returns_to_its_bind_pose(story: Story) -> None:
    """Of two objects of one name the first is followed."""
    skeleton, clip = synthetic_avatar(1).rig.skeleton, synthetic_avatar(1).clips[0]
    found = [np.array(line.split(), float) for line in story("LosesJoint", "first")["last"]]
    for rotation, expected in zip(found, (clip.rotations[2, -1], skeleton.bind_rotations[-1]), strict=True):
        assert abs(rotation @ expected) == pytest.approx(1, abs=1e-5)


def test_an_avatar_casts_no_shadow_before_it_has_a_shape(story: Story) -> None:
    assert story("IsNotDrawnYet", "first")["shadows"] == ["Ready 0", "Ready 2"]  # of three frames


def test_an_inactive_joint_counts_as_missing(story: Story) -> None:
    assert synthetic_avatar(1).rig.skeleton.names[-1] in story("HasInactiveJoint", "first")["missing"][0]


def test_cameras_and_lights_are_told_the_layer_of_each_avatar(story: Story) -> None:
    """All avatars are drawn together where the layer of one is drawn."""
    told = story("LiesOnLayers", "first", "second")
    assert told["drawn"] == ["1", "1", "0"]
    layer, away = told["shadow"][0].split()
    assert (layer, float(away)) == ("7", pytest.approx(0, abs=1e-5))
    assert float(told["shadow size"][0]) == pytest.approx(1, abs=1e-5)


def test_transforms_give_the_pose_wherever_their_root_stands(story: Story) -> None:
    told = story("FollowsRig", "first")
    assert float(told["turned"][0]) < TURNED
    assert float(told["translated"][0]) < TRANSLATED


def test_an_avatar_whose_rig_rests_is_only_sorted(story: Story) -> None:
    """Once its window holds nothing but the pose in which it rests: as long as that is, it is decoded."""
    told = story("RigRests", "first")
    sorting = len(FRAME_ORDER[FRAME_ORDER.index("SplatProject") :])
    posed = len(FRAME_ORDER[FRAME_ORDER.index("BlendVertices") :])
    window = synthetic_avatar(1).encoding.window
    assert told["settling"] == [str(len(FRAME_ORDER) + (SECOND - 1) * sorting)]  # the first frame fills the window
    assert told["idle"] == [str(10 * sorting)] * 3
    for moved in ("woken", "stepped"):
        decodes, reposes = divmod(int(told[moved][0]) - SECOND * sorting, len(FRAME_ORDER) - sorting)
        assert decodes == window
        assert reposes in (0, posed - sorting)  # the frame that moved, where it is none of the avatar's own rate
    assert told["carried"] == [str(posed)]
    assert told["left"] == [str(len(FRAME_ORDER))]


def test_a_rig_that_is_picked_in_the_inspector_is_followed(story: Story) -> None:
    told = story("RigIsPicked", "first")
    sorting = len(FRAME_ORDER[FRAME_ORDER.index("SplatProject") :])
    assert told["idle"] == [str(10 * sorting)]
    assert int(told["woken"][0]) > 10 * sorting


def test_a_rig_that_rested_is_remembered_resting(story: Story) -> None:
    told = story("RemembersRest", "first")
    assert told["changes"] == ["1", "1"]
    assert (told["fresh"], told["rests"]) == (["1"], ["1"])


def test_the_window_takes_a_pose_in_each_frame_of_the_avatars_rate(story: Story) -> None:
    """On a display three times as fast; it goes on after 3 frames without a pose, starts anew after 4 or going back."""
    told = story("WindowTakesTurns", "first")
    window = synthetic_avatar(1).encoding.window
    assert window == 3
    assert told["window"] == ["12 9 6", "13 12 9", "14 14 14", "15 14 14", "16 16 16"]
    assert [float(number) for number in told["before"]] == [pytest.approx(0.5), pytest.approx(1)]
    assert told["steady"] == ["300"]  # one pose in each frame
    assert told["other clip"] == ["1"]  # is another window, though both play their first frame


def test_a_rig_that_is_destroyed_is_said_once(story: Story) -> None:
    told = story("FollowsRig", "first")
    assert told["state"] == ["Ready"]
    assert len(told["log"]) == 1
    assert "destroyed" in told["log"][0]


def test_missing_joints_are_said_once(story: Story) -> None:
    told = story("LacksJoint", "first")
    assert told["state"] == ["Ready"]
    some, root = told["log"]
    assert synthetic_avatar(1).rig.skeleton.names[-1] in some
    assert "root joint" in root


def test_a_scale_is_refused_once(story: Story) -> None:
    told = story("IsScaled", "first")
    assert told["state"] == ["Ready"]
    assert len(told["log"]) == 1
    assert "avatars ignore" in told["log"][0]


def counts(seed: int) -> list[int]:
    """Splats of the levels of a synthetic avatar."""
    return [len(synthetic_avatar(seed).at_level(level).rig.texels.texels) for level in range(3)]


def test_the_level_follows_the_camera_or_what_is_asked_for(story: Story) -> None:
    told, levels = story("ChangesLevel", "first"), counts(1)
    assert told["distance"] == [str(levels[level]) for level in (0, 2, 0)]
    assert told["asked"] == [str(levels[level]) for level in (1, 2, 0)]
    assert told["nearest"] == [str(levels[level]) for level in (0, 2, 0)]  # of two cameras, then one
    assert told["still"] == [str(len(FRAME_ORDER))]
    assert told["geometry"] == [str(levels[0])]
    assert told["log"] == []


def test_texels_are_measured_at_the_nearest_point_that_is_drawn(story: Story) -> None:
    """That is the near plane, 0.25 m away, where the eye is within the avatar's box."""
    told = story("MeasuresTexels", "first")
    focal = float(told["focal"][0])
    seen = [tuple(map(float, line.split())) for line in told["seen"]]
    for found, wanted in zip(seen, [(0, focal / 0.25)] * 2 + [(2, focal / 2)] * 2, strict=True):
        assert found == pytest.approx(wanted, rel=1e-4)


def test_avatars_share_a_budget_the_nearest_first(story: Story) -> None:
    told, first, second = story("SharesBudget", "first", "second"), counts(1), counts(2)
    assert told["splats"] == [f"{first[i]} {second[j]}" for i, j in ((0, 0), (0, 1), (2, 2))]
    assert told["one camera"] == [f"{first[0]} {second[1]}"]
    assert told["two cameras"] == [f"{first[1]} {second[0]}"]  # of which another one is nearer to the second
    assert told["fixed"] == [f"{first[2]} {second[0]}"] * 2
    assert told["alone"] == [str(first[0])]  # what is not in view takes nothing off
    assert told["later"] == [f"{first[0]} {second[0]}", f"{first[2]} {second[2]}"]  # the budget that came last counts
    assert told["free"] == [f"{first[0]} {second[0]}"]
    assert told["allocated"] == ["0"]
    assert told["log"] == []


def test_a_level_that_is_picked_in_the_inspector_is_checked(story: Story, folder: Path) -> None:
    avatar = synthetic_avatar(1)
    taps = {name: np.pad(getattr(avatar.wavelet, name), 12) for name in ("rec_lo", "rec_hi")}
    write(folder / "long.muaavatar", replace(avatar, wavelet=replace(avatar.wavelet, **taps)), storage="f16")
    told = story("LevelIsPicked", "long")
    assert told["message"] == ["", "the avatar has no such level of detail; it is shown at full size."]
    assert told["budget"] == ["0 0"]


def test_an_avatar_that_lacks_the_level_asked_for_is_shown_at_full_size(story: Story, folder: Path) -> None:
    """Not at the coarsest that it has."""
    avatar = synthetic_avatar(1, levels=3)
    write(folder / "two.muaavatar", avatar, storage="f16")
    assert avatar.at_level(1) is not None
    told = story("LevelIsPicked", "two")
    assert told["message"][1].startswith("the avatar has no such level of detail")
    assert told["splats"] == [str(len(avatar.rig.texels.texels))]


def test_an_avatar_without_levels_says_so_once_and_shows_all(story: Story, folder: Path) -> None:
    avatar = synthetic_avatar(1)
    taps = {name: np.pad(getattr(avatar.wavelet, name), 12) for name in ("rec_lo", "rec_hi")}
    write(folder / "long.muaavatar", replace(avatar, wavelet=replace(avatar.wavelet, **taps)), storage="f16")
    told = story("LacksLevel", "long")
    assert told["splats"] == [str(counts(1)[0])] * 2
    sentence = "the avatar has no such level of detail; it is shown at full size."
    assert told["message"] == [sentence]
    assert [line.rpartition(": ")[2] for line in told["log"]] == [sentence]
