"""No option of a command is read and ignored: each alone changes what is carried out.

HELD names, for every option of every command, the test that fails where it is dropped on its way; those of mua-bake,
mua-train and mua-teach also change the order that the later stages are given.
"""

import importlib
import inspect
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from typing import Any

import pytest
from captures import ring

import mua
from mua.baking.options import read_order
from mua.capture import Capture, CaptureClip, write_capture

BAKE = {
    "output": "b.muaavatar",
    "character": "figure.glb",
    "motion": ["walk.bvh"],
    "hold_out": ["walk"],
    "clips": "none",
    "preset": "paper",
    "recipe": "paper",
    "frames": 9,
    "texels": 64,
    "mapping": {"hips": "pelvis"},
    "feet": "keep",
    "motion_range": "none",
    "leave_out": ["hat"],
    "uv": "unwrap",
    "detail": {"head": 2},
    "scale": 2.0,
    "height": 1.5,
    "storage": "i8",
    "jobs": 9999,
    "seed": 3,
    "device": "cpu",
    "work": "elsewhere",
}
TRAIN = {name: BAKE[name] for name in ("output", "preset", "recipe", "clips", "storage", "seed", "device", "work")}
TRAIN["stage"] = "bases"
TEACH = {
    "output": "other",
    "preset": "small",
    "steps": 7,
    "texels": 64,
    "drivable": True,
    "refine": 2.0,
    "lpips_weights": "weights.pth",
    "rasteriser": "gsplat",
    "seed": 3,
    "device": "cpu",
}


REACHES, VIEWED = "bake_reaches.test_an_option_is_seen_in_what_the_late_stages_get", "view_reaches."
LOOKS, PLAYS = VIEWED + "test_a_window_looks_otherwise", VIEWED + "test_a_window_plays_the_clip_asked_for"
MOVED = VIEWED + "test_a_window_plays_motion_of_another_file_on_the_joints_of_the_mapping"
TRAINED, WRITTEN = "cli_train.test_stages_one_by_one_end_in_the_same_bytes", "export_command."
FOLDER, BENCHED = "share.test_a_folder_holds_player_avatar_poster_and_page", "bench."
INSTALLED = "deploy.test_installs_pushes_and_starts"
MEASURED = "deploy.test_bench_has_the_rate_and_the_seconds_asked_for"
HELD = {  # of every command: its function, and for each option the test that holds it
    "bake": ("main", dict.fromkeys(BAKE, REACHES) | {
        "teacher": "bake_taught.test_a_capture_becomes_an_avatar_and_so_does_its_teacher",
        "check": "check.test_leaves_a_picture_a_mapping_and_figures_and_no_avatar",
        "json": "check.test_leaves_a_picture_a_mapping_and_figures_and_no_avatar",
    }),
    "train": ("main", {
        "recording": "cli_train.test_leaves_an_avatar_of_the_recordings_texture_size",
        "output": "cli_train.test_leaves_an_avatar_of_the_recordings_texture_size",
        "preset": "cli_train.test_a_preset_says_how_large_the_student_is",
        "recipe": "cli_train.test_the_papers_recipe_has_two_stages",
        "stage": TRAINED,
        "clips": "cli_train.test_what_is_stored_is_chosen_without_training_again",
        "storage": "cli_train.test_what_is_stored_is_chosen_without_training_again",
        "seed": "cli_train.test_another_seed_is_another_training",
        "device": "cli_train.test_a_gpu_that_is_not_there_is_named",
        "work": "cli_train.test_what_is_stored_is_chosen_without_training_again",
        "check": "cli_train.test_a_check_reports_on_the_recording_and_trains_nothing",
    }),
    "view": ("view", {
        **dict.fromkeys(("azimuth", "elevation", "zoom", "look_at", "background", "show", "level"), LOOKS),
        **dict.fromkeys(("stereo", "ipd"), LOOKS),
        **dict.fromkeys(("clip", "frame"), PLAYS),
        **dict.fromkeys(("motion", "mapping"), MOVED),
        **dict.fromkeys(("orbit", "follow"), VIEWED + "test_a_window_goes_round_and_follows_as_asked_for"),
        "files": "player_window.test_every_key_does_what_the_panel_says",
        "size": VIEWED + "test_a_window_is_as_large_as_asked_for_and_twice_as_wide_with_two_eyes",
        "device": VIEWED + "test_a_window_is_drawn_by_the_device_asked_for",
        "output": "view.test_writes_an_image_of_the_size_and_background_asked_for",
        "frames": "view.test_writes_a_video_of_the_frames_asked_for",
        "turntable": VIEWED + "test_videos_last_as_long_as_the_motion_and_turntables_as_their_turn",
        "list_devices": "view.test_lists_devices_without_a_file",
        "reference": VIEWED + "test_the_reference_draws_without_a_device",
        "web": "share.test_mua_view_serves_until_it_is_interrupted",
        "no_open": VIEWED + "test_a_page_opens_in_a_browser_unless_asked_not_to",
    }),
    "export": ("export", {
        "file": WRITTEN + "test_frames_of_a_sequence_are_those_of_the_clip",
        "output": WRITTEN + "test_a_sequence_has_a_file_for_each_frame",
        "clip": WRITTEN + "test_a_clip_is_chosen_by_its_name",
        "frames": WRITTEN + "test_frames_of_a_sequence_are_those_of_the_clip",
        "what": "export_usd.test_a_stage_says_its_units_axis_times_and_default_prim",
        "motion": WRITTEN + "test_motion_of_another_file_is_exported_too",
        "mapping": WRITTEN + "test_a_mapping_says_which_joint_moves_and_a_name_which_of_several_motions",
        "axes": WRITTEN + "test_a_ply_is_y_down_and_a_spz_y_up_unless_asked",
    }),
    "share": ("share", {
        "files": "share.test_avatars_of_one_name_and_of_odd_names_all_have_a_place",
        "output": FOLDER,
        "title": FOLDER,
        "clip": "share.test_poster_and_page_begin_with_the_clip_asked_for",
        "single_file": "share.test_a_single_file_holds_the_avatar_and_allows_only_its_own_script",
        "reference": VIEWED + "test_the_reference_draws_without_a_device",
    }),
    "pack": ("pack", {
        "file": "pack.test_packs_beside_the_file_by_default_and_names_both_sizes",
        "output": "pack.test_a_packed_file_becomes_a_plain_one_with_the_same_numbers",
        "storage": "pack.test_writes_the_storage_asked_for",
    }),
    "inspect": ("inspect", {
        "file": "inspect.test_shows_skeleton_texels_ranks_costs_and_clips",
        "verify": "inspect.test_verify_accepts_a_sound_file",
        "as_json": "inspect.test_json_holds_all_that_the_tables_show_and_the_names_that_the_guide_lists",
    }),
    "bench": ("bench", {
        "file": BENCHED + "test_prints_every_kernel_and_writes_the_same_figures",
        "preset_name": BENCHED + "test_measures_a_setting_without_a_file",
        "device": BENCHED + "test_measures_as_many_frames_on_the_device_asked_for",
        "frames": BENCHED + "test_measures_as_many_frames_on_the_device_asked_for",
        "size": BENCHED + "test_prints_every_kernel_and_writes_the_same_figures",
        "stereo": BENCHED + "test_prints_every_kernel_and_writes_the_same_figures",
        "counts": "bench_counts.test_counts_what_a_frame_must_do",
        "model": "bench_model.test_prints_the_model_beside_what_is_measured",
        "output": BENCHED + "test_measures_as_many_frames_on_the_device_asked_for",
    }),
    "deploy": ("deploy", {
        "avatars": INSTALLED,
        "apk": INSTALLED,
        "project": "deploy.test_builds_with_unity_what_it_installs",
        "unity": "deploy.test_builds_with_unity_what_it_installs",
        "serial": "deploy.test_serial_chooses_between_headsets",
        "test": "deploy.test_self_test_passes",
        "seconds": MEASURED,
        "rate": MEASURED,
        "output": MEASURED,
        "doctor": "deploy_doctor.test_the_command_shows_every_check_and_names_those_that_are_not_ok",
    }),
}  # fmt: skip


@pytest.fixture(autouse=True)
def files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("figure.glb", "walk.bvh", "weights.pth"):
        Path(name).write_bytes(b"not looked into")


def defaults(function: Callable[..., Any]) -> dict[str, Any]:
    parameters = inspect.signature(function).parameters.values()
    return {one.name: one.default for one in parameters if one.default is not one.empty and one.name != "listener"}


def changed(one: Any, other: Any) -> set[str]:
    """The fields in which two orders differ."""
    return {field.name for field in fields(one) if getattr(one, field.name) != getattr(other, field.name)}


@pytest.mark.parametrize("command", HELD)
def test_every_option_has_a_test_that_holds_it(command: str) -> None:
    function, held = HELD[command]
    parameters = inspect.signature(getattr(importlib.import_module(f"mua.cli.{command}"), function)).parameters
    assert set(held) == set(parameters) - {"context"}
    for module, test in (named.split(".") for named in held.values()):
        assert callable(getattr(importlib.import_module(f"test_{module}"), test)), f"{module}: {test}"


def test_no_case_of_a_bake_stands_for_an_option_that_is_gone() -> None:
    from test_bake_reaches import REACHES as cases

    assert set(cases) == set(BAKE)


def test_every_option_of_a_bake_has_a_case() -> None:
    assert set(BAKE) == set(defaults(mua.bake)) - {"teacher"}


@pytest.mark.parametrize("option", BAKE)
def test_an_option_of_a_bake_changes_its_order(option: str) -> None:
    given = defaults(mua.bake) | ({"motion": ["walk.bvh"]} if option == "mapping" else {})
    found = changed(read_order(given), read_order(given | {option: BAKE[option]}))
    assert found - {"work"} if option == "output" else len(found) == 1


@pytest.mark.parametrize("option", TRAIN)
def test_an_option_of_a_training_changes_its_order(option: str, monkeypatch: pytest.MonkeyPatch) -> None:
    orders: list[Any] = []
    monkeypatch.setattr(
        importlib.import_module("mua.baking.train"), "_distil", lambda _, order, __: orders.append(order)
    )
    for options in ({}, {option: TRAIN[option]}):
        mua.train(object(), **options)
    assert set(TRAIN) == set(defaults(mua.train))
    found = changed(*orders)
    assert found - {"work"} if option == "output" else len(found) == 1


@pytest.mark.parametrize("option", TEACH)
def test_an_option_of_a_lesson_changes_its_order(option: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    cameras, clip = tuple(ring()), CaptureClip("walk", tmp_path / "walk.bvh", 0, 2)
    write_capture(
        Capture(tmp_path / "capture", "figure", 30.0, tmp_path / "figure.glb", cameras, (clip,), "{camera}/{frame}.png")
    )
    orders: list[Any] = []
    monkeypatch.setattr(importlib.import_module("mua.baking.teach"), "_teach", lambda order, *_: orders.append(order))
    monkeypatch.setattr("mua.baking.teach.find_spec", bool)  # gsplat is not among what tests install
    for options in ({}, {option: TEACH[option]}):
        mua.teach(tmp_path / "capture", **options)
    assert set(TEACH) == set(defaults(mua.teach))
    assert len(changed(*orders)) == 1
