"""Training data from a capture: nothing that is held out, each frame with its own poses, and what it looks at."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import torch
from captures import FRAMES, make_capture
from PIL import Image
from small_teachers import FEW, SETTINGS, material, motion, teacher

from mua import rotation
from mua.arrays import Array
from mua.baking.capture_motion import filmed_clips
from mua.capture import Capture, CaptureClip
from mua.errors import InputError
from mua.motion.poses_file import write_poses
from mua.teachers.trained.from_capture import (
    OUTLINES,
    Filmed,
    Outlines,
    material_of,
    preview_of,
    read_filmed,
    refinement_of,
)
from mua.teachers.trained.image_losses import ImageLoss
from mua.teachers.trained.preview import Preview, picture_of, psnr
from mua.teachers.trained.track_losses import TexelTracks
from mua.teachers.trained.tracked_points import tracks_of

CPU = torch.device("cpu")
ROWS = 32
STEP = 0.5 / 255 + 1e-6  # by which an image of 8 bits is rounded


@pytest.fixture(scope="module")
def capture(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Capture]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("mua.capture.capture.ATLAS", 64)
        yield make_capture(tmp_path_factory.mktemp("capture"))


@pytest.fixture(scope="module")
def filmed(capture: Capture, tmp_path_factory: pytest.TempPathFactory) -> Filmed:
    return read_filmed(capture, replace(FEW, texels=32, rows=ROWS), CPU, views=tmp_path_factory.mktemp("views"))


@pytest.fixture(scope="module")
def both(filmed: Filmed) -> Filmed:
    """The capture with all clips for training."""
    return replace(filmed, clips=(*filmed.clips, *filmed.held), held=())


def test_what_is_held_out_is_not_trained_on(filmed: Filmed, monkeypatch: pytest.MonkeyPatch) -> None:
    asked = set()
    monkeypatch.setattr(Filmed, "see", lambda self, clip, frame, camera: asked.add((clip, frame, camera.name)))
    views = material_of(filmed).views
    for frame in range(views.frames):
        for camera in range(views.cameras):
            views.see(frame, camera)
    assert asked == {("walk", frame, camera) for frame in range(4) for camera in ("front", "left", "right")}
    assert [clip.name for clip in filmed.held] == ["reach"]


def test_a_view_is_that_of_the_capture_and_weighs_what_its_mask_is_trusted(capture: Capture, filmed: Filmed) -> None:
    trusted = replace(filmed, trust=SimpleNamespace(weight=lambda clip, frame, view: 0.1 * frame))  # type: ignore[arg-type]
    seen = trusted.see("walk", 3, capture.camera("left"))
    view = capture.view("walk", 3, "left", crop=True, rows=ROWS)
    np.testing.assert_array_equal(seen.image, view.image)
    np.testing.assert_array_equal(seen.mask, view.mask)
    np.testing.assert_allclose(seen.eye.view, view.camera.view, rtol=1e-6)
    assert seen.weight == pytest.approx(0.3)
    assert seen.background is None


def test_each_frame_has_the_poses_of_its_own_clip(both: Filmed) -> None:
    """Frames are numbered over all clips; before its first frame a clip is held still."""
    own = material_of(both)
    assert (own.views.frames, len(own.windows)) == (6, 6)
    clips = [clip.name for clip in both.clips for _ in range(len(clip))]
    for (clip, frame), window in zip(
        [(clip, i - clips.index(clip)) for i, clip in enumerate(clips)], own.windows, strict=True
    ):
        motion = both.capture.motion(clip)
        joints = both.subject.rig.skeleton.skinning(motion.rotations, motion.translations)
        wanted = [joints[max(frame - age, 0)] for age in range(3)]
        np.testing.assert_allclose(window.joints, wanted, atol=1e-5)
    refinement = refinement_of(both, replace(FEW, refine=3.0))
    assert refinement is not None
    for frame, window in enumerate(own.windows):
        torch.testing.assert_close(refinement(frame).detach(), window.joints, atol=1e-5, rtol=0)


@pytest.mark.parametrize("rate", [6.0, 15.0, 25.0, 60.0])
def test_windows_are_a_thirtieth_of_a_second_apart_at_any_rate_of_the_images(
    capture: Capture, tmp_path: Path, rate: float
) -> None:
    """In the teacher that is trained, in what is recorded of it, and so in the file: as long between the same poses."""
    whole = capture.whole_motion("walk")
    turning = np.arange(41) / 30  # seconds; the poses of the motion's file, in which the root moves at a steady pace
    steady = replace(
        whole,
        rotations=np.repeat(whole.rotations[:1], 41, axis=0),
        translations=np.repeat(whole.translations[:1], 41, axis=0),
    )
    root = capture.surfaces.skeleton.root
    steady.translations[:, root, 0] += turning**2
    write_poses(tmp_path / "steady.npz", capture.surfaces.skeleton, steady)
    first, frames = round(0.2 * rate), 4
    clip = CaptureClip("walk", tmp_path / "steady.npz", first, frames)
    own = replace(capture, rate=rate, clips=(clip,))
    filmed = read_filmed(own, replace(FEW, texels=32, rows=ROWS), CPU, views=tmp_path / "views")
    (walk,) = filmed.clips
    path = steady.translations[0, root, 0]
    for frame, window in enumerate(filmed.windows(walk)):
        seconds = (first + frame) / rate - np.minimum(np.arange(3) / 30, frame / rate)
        moved = dual_places(window.joints[:, root].double().numpy(), root, own)
        np.testing.assert_allclose(moved - path, seconds**2, atol=1.5e-3)
    assert filmed.subject.encoding.rate == 30
    (recorded, *_) = filmed_clips(own)
    assert recorded.rate == 30
    at = first / rate + np.arange(len(recorded)) / 30
    np.testing.assert_allclose(recorded.translations[:, root, 0] - path, at**2, atol=1.5e-3)


def dual_places(joints: Array, joint: int, capture: Capture) -> Array:
    """Where a joint [k, 8] is along X."""
    skeleton = capture.surfaces.skeleton
    rest = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)[1][joint]
    return np.stack([rotation.dual_transform(own, rest)[0] for own in joints])


def test_points_beside_the_person_change_nothing_for_the_others(filmed: Filmed, tmp_path: Path) -> None:
    capture = replace(filmed.capture, tracks=f"{tmp_path}/{{clip}}.npz")

    def read(bind: Array) -> list[TexelTracks]:
        np.savez(tmp_path / "walk.npz", points=np.zeros((FRAMES["walk"], len(bind), 3)), bind=bind)
        return tracks_of(replace(filmed, capture=capture))

    bind = filmed.subject.rig.mesh.vertices[::9]
    among = np.full((2 * len(bind), 3), 9.0)
    among[1::2] = bind
    for one, other in zip(read(among), read(bind), strict=True):
        assert torch.equal(one.texels, other.texels)
        assert torch.equal(one.tracks.corners, other.tracks.corners)
    assert len(torch.unique(other.texels)) > 10


def test_poses_are_refined_only_where_that_is_asked_for(both: Filmed) -> None:
    assert refinement_of(both, FEW) is None


def test_outlines_are_masks_of_different_cameras_of_the_frame(both: Filmed) -> None:
    shown = material_of(both)
    outlines = Outlines(shown)
    found = outlines.observe(5, torch.Generator().manual_seed(0)).outlines
    masks = [shown.views.see(5, camera).mask for camera in range(shown.views.cameras)]
    which = {next(i for i, mask in enumerate(masks) if torch.equal(mask, one.mask)) for one in found}
    assert len(found) == len(which) == OUTLINES
    torch.testing.assert_close(outlines.joints[5], shown.windows[5].joints[0])
    assert outlines.descriptors.shape == (6, both.subject.encoding.width)


def test_a_preview_is_of_the_middles_of_both_kinds_of_clips_by_a_camera_held_out(
    capture: Capture, filmed: Filmed, both: Filmed, tmp_path: Path
) -> None:
    preview = preview_of(filmed, tmp_path)
    for (seen, window), (clip, frames) in zip(preview.seen, FRAMES.items(), strict=True):
        view = capture.view(clip, frames // 2, "above", crop=True, rows=ROWS)
        np.testing.assert_array_equal(seen.image, view.image)
        own = capture.motion(clip).pose(frames // 2)
        placed = filmed.subject.rig.skeleton.world(own.rotations, own.translations)[1]
        np.testing.assert_allclose(window.root, placed[filmed.subject.rig.skeleton.root], atol=1e-5)
    assert len(preview_of(both, tmp_path).seen) == 1


def test_refuses_a_capture_with_nothing_to_train_on(capture: Capture, tmp_path: Path) -> None:
    clips = tuple(replace(clip, held_out=True) for clip in capture.clips)
    cameras = tuple(replace(camera, held_out=True) for camera in capture.cameras)
    for nothing in (replace(capture, clips=clips), replace(capture, cameras=cameras)):
        with pytest.raises(InputError, match="every clip or every camera is held out"):
            read_filmed(nothing, FEW, CPU, views=tmp_path)


@pytest.mark.parametrize(
    ("steps", "expected"),
    [(60, [25, 50, 60]), (10, [10]), (4000, list(range(200, 4001, 200)))],
)
def test_pictures_of_progress_are_few_and_the_last_step_has_one(
    tmp_path: Path, steps: int, expected: list[int]
) -> None:
    preview = Preview(tmp_path, [])
    assert [step for step in range(1, steps + 1) if preview.due(step, steps)] == expected


def test_a_preview_shows_the_picture_the_teacher_and_their_difference(tmp_path: Path) -> None:
    shown = material()
    image_loss = ImageLoss(teacher(), shown, SETTINGS)
    with torch.no_grad():
        image_loss.looks.normal_(generator=torch.Generator().manual_seed(1))
    seen = [(shown.views.see(frame, 1), motion()[2 * frame]) for frame in (0, 2)]
    found = Preview(tmp_path, seen)(image_loss, "texels", moving=True)
    with Image.open(tmp_path / "texels.png") as opened:
        pixels = np.asarray(opened) / 255
    rows, scores = [], []
    for one, window in seen:
        truth = one.over(torch.ones(3)).numpy()
        image = picture_of(image_loss.teacher, window, one, look=image_loss.looks.mean(dim=0))
        rows.append(np.hstack([truth, image, np.clip(1 - 4 * np.abs(image - truth), 0, 1)]))
        scores.append(psnr(image, truth))
    np.testing.assert_allclose(pixels, np.clip(np.vstack(rows), 0, 1), atol=STEP)
    assert found == pytest.approx(np.mean(scores))
    assert [path.name for path in tmp_path.iterdir()] == ["texels.png"]


def test_psnr_of_a_tenth_is_twenty() -> None:
    truth = np.full((4, 5, 3), 0.5)
    assert psnr(truth + 0.1, truth) == pytest.approx(20)
