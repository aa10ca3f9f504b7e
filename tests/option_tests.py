"""For every option of every command, the test that fails where the command ignores it.

test_options_count.py holds the table complete; test_options_ignored.py drops each option and runs its test.
"""

from typing import NamedTuple


class Held(NamedTuple):
    """A function that has the options of a command, and for each the test, after `test_`, that holds it."""

    module: str
    function: str
    tests: dict[str, str]


REACHES, VIEWED = "bake_reaches.test_an_option_is_seen_in_what_the_late_stages_get", "view_reaches."
BAKED = (
    *("character", "motion", "output", "preset", "frames", "texels", "hold_out", "clips", "leave_out", "mapping"),
    *("feet", "motion_range", "uv", "detail", "scale", "height", "recipe", "storage", "seed", "device", "jobs", "work"),
)
LOOKS, PLAYS = VIEWED + "test_a_window_looks_otherwise", VIEWED + "test_a_window_plays_the_clip_asked_for"
MOVED = VIEWED + "test_a_window_plays_motion_of_another_file_on_the_joints_of_the_mapping"
WRITTEN, BENCHED = "export_command.", "bench."
STORED = "cli_train.test_what_is_stored_is_chosen_without_training_again"
TAUGHT = "teach_options.test_a_teacher_says_what_it_was_trained_with"
SCORED, COUNTED = "eval.test_the_command_writes_tables_plots_and_sheets", "eval.test_every_option_of_the_images_counts"
SIZED = "eval_capture.test_the_command_trains_systems_at_several_sizes_and_once"
KEPT = "eval.test_a_trained_system_is_not_trained_again"
DESCRIBED = "capture_streams.test_what_is_said_of_a_capture_is_in_its_description"
CALIBRATED = "capture_calibrations.test_pictures_become_clips_without_those_that_a_camera_lacks"
POSED = "capture_keypoint_files.test_a_person_is_posed_by_the_folder_of_a_world_with_z_up"
FOLDER = "share.test_a_folder_holds_player_avatar_poster_and_page"
INSTALLED = "deploy.test_installs_pushes_and_starts"
MEASURED = "deploy.test_bench_has_the_rate_and_the_seconds_asked_for"

HELD = {
    "bake": Held("mua.cli.bake", "main", {name: f"{REACHES}[{name}-bake]" for name in BAKED} | {
        "teacher": "bake_taught.test_a_capture_becomes_an_avatar_and_so_does_its_teacher",
        "check": "check.test_leaves_a_picture_a_mapping_and_figures_and_no_avatar",
        "json": "check.test_leaves_a_picture_a_mapping_and_figures_and_no_avatar",
    }),
    "train": Held("mua.cli.train", "main", {
        "recording": "cli_train.test_leaves_an_avatar_of_the_recordings_texture_size",
        "output": "cli_train.test_leaves_an_avatar_of_the_recordings_texture_size",
        "preset": "cli_train.test_a_preset_says_how_large_the_student_is",
        "recipe": "cli_train.test_the_papers_recipe_has_two_stages",
        "stage": "cli_train.test_stages_one_by_one_end_in_the_same_bytes",
        "clips": STORED,
        "storage": STORED,
        "seed": "cli_train.test_another_seed_is_another_training",
        "device": "cli_train.test_a_gpu_that_is_not_there_is_named",
        "work": STORED,
        "check": "cli_train.test_a_check_reports_on_the_recording_and_trains_nothing",
    }),
    "view": Held("mua.cli.view", "view", {
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
    "export": Held("mua.cli.export", "export", {
        "file": WRITTEN + "test_frames_of_a_sequence_are_those_of_the_clip",
        "output": WRITTEN + "test_a_sequence_has_a_file_for_each_frame",
        "clip": WRITTEN + "test_a_clip_is_chosen_by_its_name",
        "frames": WRITTEN + "test_a_sequence_has_a_file_for_each_frame",
        "what": "export_gltf.test_trimesh_reads_the_detailed_geometry_with_its_colours",
        "motion": WRITTEN + "test_motion_of_another_file_is_exported_too",
        "mapping": WRITTEN + "test_a_mapping_says_which_joint_moves_and_a_name_which_of_several_motions",
        "axes": WRITTEN + "test_splats_of_all_formats_stand_alike_y_down_unless_asked",
    }),
    "share": Held("mua.cli.share", "share", {
        "files": "share.test_avatars_of_one_name_and_of_odd_names_all_have_a_place",
        "output": FOLDER,
        "title": FOLDER,
        "clip": "share.test_poster_and_page_begin_with_the_clip_asked_for",
        "single_file": "share.test_a_single_file_holds_the_avatar_and_allows_only_its_own_script",
        "reference": VIEWED + "test_the_reference_draws_without_a_device",
    }),
    "pack": Held("mua.cli.pack", "pack", {
        "file": "pack.test_packs_beside_the_file_by_default_and_names_both_sizes",
        "output": "pack.test_a_packed_file_becomes_a_plain_one_with_the_same_numbers",
        "storage": "pack.test_writes_the_storage_asked_for",
    }),
    "inspect": Held("mua.cli.inspect", "inspect", {
        "file": "inspect.test_shows_skeleton_texels_ranks_costs_and_clips",
        "verify": "inspect.test_verify_accepts_a_sound_file",
        "as_json": "inspect.test_json_holds_all_that_the_tables_show_and_the_names_that_the_guide_lists",
    }),
    "bench": Held("mua.cli.bench", "bench", {
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
    "deploy": Held("mua.cli.deploy", "deploy", {
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
    "teach": Held("mua.baking.teach", "teach", {
        **dict.fromkeys(("capture", "output", "preset", "steps", "texels", "drivable", "colour_correction"), TAUGHT),
        **dict.fromkeys(("refine", "lpips_weights", "seed"), TAUGHT),
        "rasteriser": "gsplat_views.test_gsplat_that_is_not_installed_is_a_sentence",
        "device": "teach_options.test_a_gpu_that_is_not_there_is_named",
    }),
    "eval": Held("mua.cli.eval", "evaluate", {
        **dict.fromkeys(("recording", "avatars", "system", "size", "output"), SCORED),
        **dict.fromkeys(("preset", "seconds", "steps", "seed"), KEPT),
        **dict.fromkeys(("frames", "views", "own_mesh", "lpips_weights", "device"), COUNTED),
        "teacher": "eval_capture.test_the_command_compares_a_teacher_with_the_pictures",
        "images": "eval_capture.test_the_command_compares_a_teacher_with_the_pictures",
        **dict.fromkeys(("train_on", "scale"), SIZED),
    }),
    "capture check": Held("mua.cli.capture", "check", {
        "folder": "capture_check.test_the_command_prints_what_it_found",
        "output": "capture_check.test_the_command_prints_what_it_found",
        "frames": "capture_check.test_the_command_looks_at_as_many_frames_as_asked_for",
    }),
    "capture describe": Held("mua.cli.capture", "describe", {
        **dict.fromkeys(("source", "output", "template", "motion", "rate", "height", "leave_out"), DESCRIBED),
        "calibration": CALIBRATED,
        **dict.fromkeys(("axes", "scale"), "capture_calibrations.test_the_command_takes_unit_and_axes_back"),
    }),
    "capture poses": Held("mua.cli.capture_poses", "poses", {
        **dict.fromkeys(("keypoints", "template", "output", "axes", "scale", "rate"), POSED),
        "height": "capture_keypoints.test_a_template_of_another_height_has_limbs_as_long_as_the_persons",
    }),
}  # fmt: skip
