"""Whether what mua-teach is given reaches the teacher, also where an earlier training lies in the same folder."""

import json
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
from captures import FRAMES, make_capture
from commands import Commands
from PIL import Image
from pretended_card import pretended_card
from small_teachers import FEW, material, teacher
from small_teachers import SETTINGS as SMALL
from torch import Tensor

import mua
from mua.baking import teacher_stages
from mua.capture import open_capture
from mua.capture.silhouette import pixels, posed_template
from mua.capture.write import write_capture
from mua.motion.poses_file import read_poses, write_poses
from mua.splatting import perceptual
from mua.splatting.rasterise import rasterise_views
from mua.teachers.trained import model, settings
from mua.teachers.trained.folder import load_teacher
from mua.teachers.trained.image_losses import ImageLoss
from mua.teachers.trained.template_training import TemplateSettings
from mua.training.schedule import Schedule

TEXELS, STEPS = 64, 2


class Distance:
    """Stands in for LPIPS: so many times the mean difference, as the file of weights says."""

    def __init__(self, path: Path) -> None:
        self.times = float(path.read_text())

    def to(self, device: torch.device) -> "Distance":
        return self

    def distance(self, image: Tensor, truth: Tensor) -> Tensor:
        return self.times * (image - truth).abs().mean()


@pytest.fixture(autouse=True)
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    small(monkeypatch)


def small(patch: pytest.MonkeyPatch) -> None:
    few = Schedule(steps=2, batch=1, lr=1e-2)
    patch.setattr(teacher_stages, "TEMPLATE", replace(TemplateSettings(), nodes=few, offsets=few))
    patch.setattr(perceptual, "Lpips", Distance)
    patch.setitem(settings.PRESETS, "tiny", FEW)
    patch.setitem(settings.PRESETS, "small", replace(FEW, channels=5))


@pytest.fixture(scope="module")
def capture(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """With poses in files that a test may change, and points that one camera followed."""
    with pytest.MonkeyPatch.context() as patch:
        small(patch)
        folder = make_capture(tmp_path_factory.mktemp("capture") / "figure").folder
        given = open_capture(folder)
        write_poses(folder / "walk.npz", given.surfaces.skeleton, given.whole_motion("walk"))
        clips = tuple(
            replace(clip, motion=folder / "walk.npz") if clip.name == "walk" else clip for clip in given.clips
        )
        write_capture(replace(given, clips=clips, tracks_2d="tracks/{clip}/{camera}.npz"))
        followed = posed_template(given.surfaces, given.motion("walk"))[:, ::40]
        (folder / "tracks" / "walk").mkdir(parents=True)
        bind = given.surfaces.vertices[::40]
        for camera in given.cameras:
            np.savez(tracks_of(folder, camera.name), points=pixels(camera, followed)[0], bind=bind)
    return folder


def tracks_of(folder: Path, camera: str) -> Path:
    return folder / "tracks" / "walk" / f"{camera}.npz"


@pytest.fixture(scope="module")
def lpips(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("lpips") / "alexnet.pth"
    path.write_text("5")
    return path


@pytest.fixture(scope="module")
def made(capture: Path, lpips: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A teacher that every other one is compared with; tests leave it as it is."""
    with pytest.MonkeyPatch.context() as patch:
        small(patch)
        folder = tmp_path_factory.mktemp("made") / "teacher"
        return mua.teach(capture, output=folder, steps=STEPS, texels=TEXELS, lpips_weights=lpips, device="cpu")


def trained(folder: Path) -> bytes:
    return (folder / "weights.pt").read_bytes()


def again(made: Path, capture: Path, folder: Path, **changed: Any) -> Path:
    """The training of `made` with something else, where its checkpoints lie."""
    shutil.copytree(made, folder)
    return mua.teach(capture, output=folder, device="cpu", **{"steps": STEPS, "texels": TEXELS, **changed})


def test_what_is_the_same_goes_on_with_what_was_trained(
    made: Path, capture: Path, lpips: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Weights of the same content lie anywhere; nothing is drawn to train on."""
    (tmp_path / "same.pth").write_bytes(lpips.read_bytes())
    monkeypatch.setattr(ImageLoss, "forward", None)
    assert trained(again(made, capture, tmp_path / "t", lpips_weights=tmp_path / "same.pth")) == trained(made)


@pytest.mark.parametrize(
    "changed",
    [{"seed": 1}, {"refine": 2.0}, {"drivable": True}, {"colour_correction": False}, {"lpips_weights": None}],
    ids=lambda changed: next(iter(changed)),
)
def test_another_option_is_another_training(
    made: Path, capture: Path, lpips: Path, tmp_path: Path, changed: dict[str, Any]
) -> None:
    given = {"lpips_weights": lpips, **changed}
    assert trained(again(made, capture, tmp_path / "teacher", **given)) != trained(made)


def test_other_weights_of_the_same_name_are_another_training(made: Path, capture: Path, tmp_path: Path) -> None:
    other = tmp_path / "alexnet.pth"
    other.write_text("9")
    assert trained(again(made, capture, tmp_path / "teacher", lpips_weights=other)) != trained(made)


def faster(folder: Path) -> None:
    read = read_poses(folder / "walk.npz")
    rotations = read.clip.rotations.copy()
    rotations[:3] = rotations[3]
    write_poses(folder / "walk.npz", read.skeleton, replace(read.clip, rotations=rotations))


def followed_elsewhere(folder: Path) -> None:
    with np.load(tracks_of(folder, "left")) as file:
        np.savez(tracks_of(folder, "left"), points=file["points"] + 3, bind=file["bind"])


def other_pictures(folder: Path) -> None:
    """Those of another folder, of which capture.json alone tells."""
    given = open_capture(folder)
    for file in folder.glob("images/**/*.png"):
        place = folder / "light" / file.relative_to(folder / "images")
        place.parent.mkdir(parents=True, exist_ok=True)
        with Image.open(file) as opened:
            picture = np.array(opened)
        picture[..., :3] = 255 - picture[..., :3] // 2
        Image.fromarray(picture).save(place)
    write_capture(replace(given, images=given.images.replace("images/", "light/")))


@pytest.mark.parametrize("change", [faster, followed_elsewhere, other_pictures])
def test_another_capture_is_another_training(
    made: Path, capture: Path, lpips: Path, tmp_path: Path, change: Callable[[Path], None]
) -> None:
    shutil.copytree(capture, tmp_path / "capture")
    change(tmp_path / "capture")
    assert trained(again(made, tmp_path / "capture", tmp_path / "teacher", lpips_weights=lpips)) != trained(made)


def test_a_teacher_says_what_it_was_trained_with(capture: Path, lpips: Path, tmp_path: Path, command: Commands) -> None:
    ended = command(
        *("teach", capture, "-o", tmp_path / "t", "--preset", "small", "--steps", 1, "--texels", 80, "--drivable"),
        *("--no-colour-correction", "--refine", 1.5, "--lpips-weights", lpips, "--seed", 3, "--device", "cpu"),
    )
    assert ended.status == 0, ended
    assert "no perceptual term" not in ended.out
    said = json.loads((tmp_path / "t" / "teacher.json").read_text())["settings"]
    recorded = {name: said[name] for name in ("channels", "texels", "drivable", "colour_correction", "refine", "seed")}
    assert recorded == {
        **{"channels": 5, "texels": 80, "drivable": True, "colour_correction": False, "refine": 1.5, "seed": 3}
    }
    assert (said["mean"]["steps"], said["texture"]["steps"]) == (FEW.mean.steps, 1)
    assert load_teacher(tmp_path / "t")[0].rig.texels.size == 80


def test_a_gpu_that_is_not_there_is_named(
    capture: Path, tmp_path: Path, command: Commands, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(torch.cuda, "is_available", lambda: False)
    line = ("teach", capture, "-o", tmp_path / "t", "--steps", 1, "--texels", TEXELS)
    assert "--device cuda" in command(*line, "--device", "cuda").sentence
    assert not (tmp_path / "t" / "teacher.json").exists()


def test_a_card_trains_the_same_teacher(
    capture: Path, lpips: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With all that trains beside it: a drivable template, tracks, refined poses, pictures of the progress."""
    given: dict[str, Any] = {"steps": STEPS, "texels": TEXELS, "lpips_weights": lpips, "refine": 1.0}
    with pretended_card(monkeypatch):
        mua.teach(capture, output=tmp_path / "card", device="cuda", **given)
    mua.teach(capture, output=tmp_path / "cpu", device="cpu", **given)
    one, other = (load_teacher(tmp_path / name)[0].state_dict() for name in ("card", "cpu"))
    for name, values in one.items():
        torch.testing.assert_close(values, other[name], rtol=0, atol=1e-6)


def test_poses_of_held_out_clips_change_nothing_in_a_teacher(
    made: Path, capture: Path, lpips: Path, tmp_path: Path
) -> None:
    """Neither what it reads of a pose nor its weights: arms that only a held-out clip moves are not read."""
    shutil.copytree(capture, tmp_path / "capture")
    given = open_capture(tmp_path / "capture")
    held = given.whole_motion("reach")
    rotations = held.rotations.copy()
    rotations[::2, :, :] = np.roll(rotations[::2], 1, axis=1)  # joints turn as others do
    translations = held.translations.copy()
    translations[1, 1:] *= 1.5
    wild = replace(held, rotations=rotations, translations=translations)
    write_poses(tmp_path / "capture" / "wild.npz", given.surfaces.skeleton, wild)
    clips = tuple(
        replace(clip, motion=tmp_path / "capture" / "wild.npz") if clip.held_out else clip for clip in given.clips
    )
    write_capture(replace(given, clips=clips))
    folder = mua.teach(
        tmp_path / "capture", output=tmp_path / "t", steps=STEPS, texels=TEXELS, lpips_weights=lpips, device="cpu"
    )
    assert trained(folder) == trained(made)
    encodings = [load_teacher(one)[1].encoding for one in (folder, made)]
    assert encodings[0] == encodings[1]
    assert FRAMES["reach"] > 1


def test_gsplat_draws_where_it_is_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    def by_gsplat(splats: Any, eyes: Any) -> list[Tensor]:
        box = torch.stack([splats.centres.amin(dim=0), splats.centres.amax(dim=0)]).detach()
        return [0.5 * image for image in rasterise_views(splats, eyes, box)]

    monkeypatch.setattr(model, "gsplat_views", by_gsplat)
    shown, rows, black = material(), torch.arange(2), torch.zeros(2, 3)
    losses = {
        by: float(ImageLoss(teacher(), shown, replace(SMALL, rasteriser=by))(rows, black).detach())
        for by in ("mua", "gsplat")
    }
    assert losses["gsplat"] > 1.2 * losses["mua"]
