"""A teacher is trained on images, goes on after a kill to the same bytes, and is the same in two processes."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import torch
from small_teachers import (
    CAMERAS,
    FRAMES,
    SETTINGS,
    errors,
    looks_of_pictures,
    material,
    motion,
    run_in,
    subject,
    teacher,
    trained_losses,
)
from synthetic_avatar import synthetic_avatar
from together import errors as errors_of
from together import start

from mua import rotation
from mua.teachers.trained.colour_correction import ColourCorrection
from mua.teachers.trained.image_losses import ImageLoss, Material
from mua.teachers.trained.model import MOST_RESIDUAL, TeacherModel
from mua.teachers.trained.pose_refinement import PoseRefinement
from mua.teachers.trained.preview import picture_of
from mua.teachers.trained.settings import LossWeights
from mua.teachers.trained.splat_training import MEAN, TEXTURE, _loss, _rates, train_teacher
from mua.teachers.trained.views import Seen, Views
from mua.teachers.trained.windows import windows
from mua.training.optimise import Progress
from mua.training.processes import Processes
from mua.training.schedule import Schedule

ROUNDING = 1e-3  # of losses: sums in another order, which steps of Adam let grow


class Killed(BaseException):
    """Ends a run; nothing catches it."""


def state(image_loss: ImageLoss) -> dict[str, torch.Tensor]:
    return {name: tensor.clone() for name, tensor in image_loss.state_dict().items()}


def same(a: dict[str, torch.Tensor], b: dict[str, torch.Tensor]) -> bool:
    return all(torch.equal(a[name], b[name]) for name in a)


def test_training_comes_nearer_to_the_pictures_than_a_mean_texture(tmp_path: Path) -> None:
    shown = material()
    before = errors(ImageLoss(teacher(), shown, SETTINGS), shown)
    image_loss = trained_losses(
        tmp_path, settings=replace(SETTINGS, texture=replace(SETTINGS.texture, steps=40)), shown=shown
    )
    mean = errors(image_loss, shown, moving=False)
    assert mean < 0.8 * before
    assert errors(image_loss, shown) < 0.7 * mean


@pytest.mark.parametrize("killed", [(MEAN, 5), (TEXTURE, 3), (TEXTURE, 11)])
def test_a_killed_training_ends_in_the_same_bytes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, killed: tuple[str, int]
) -> None:
    monkeypatch.setattr("mua.teachers.trained.splat_training.CHECKPOINT_STEPS", 4)
    whole = state(trained_losses(tmp_path / "whole"))

    def die(progress: Progress) -> None:
        if (progress.stage, progress.step) == killed:
            raise Killed

    with pytest.raises(Killed):
        trained_losses(tmp_path / "killed", die)
    steps: list[tuple[str, int]] = []
    again = state(trained_losses(tmp_path / "killed", lambda progress: steps.append((progress.stage, progress.step))))
    assert same(whole, again)
    assert steps[0] == (killed[0], killed[1] // 4 * 4 + 1)  # it went on and did not begin anew


def test_another_seed_is_another_training(tmp_path: Path) -> None:
    other = state(trained_losses(tmp_path / "b", settings=replace(SETTINGS, seed=1)))
    assert not same(state(trained_losses(tmp_path / "a")), other)


@torch.no_grad()
@pytest.mark.parametrize("count", [2, 3, 5])
def test_parts_of_a_batch_add_up_to_its_loss(tmp_path: Path, count: int) -> None:
    shown = material()
    image_loss = ImageLoss(teacher(), shown, SETTINGS)

    def part(rank: int, count: int) -> float:
        run = run_in(tmp_path, processes=Processes(rank, count))
        return float(_loss(image_loss, material=shown, batch=4, run=run, moving=True))

    assert np.mean([part(rank, count) for rank in range(count)]) == pytest.approx(part(0, 1), rel=1e-5)


def test_two_processes_train_as_one_does(tmp_path: Path) -> None:
    alone: dict[tuple[str, int], float | None] = {}
    trained_losses(tmp_path / "alone", lambda one: alone.update({(one.stage, one.step): one.loss}))
    assert errors_of(start("teach", tmp_path), "teach", tmp_path) == ["", ""]
    (one, losses), (other, _) = (torch.load(tmp_path / f"teach.{rank}.pt") for rank in range(2))
    assert same(one, other)
    assert losses == pytest.approx(alone, rel=ROUNDING)


def test_a_camera_with_colours_of_its_own_does_not_stain_the_teacher(tmp_path: Path) -> None:
    def redder(seen: Seen, camera: int) -> Seen:
        red = torch.tensor([0.1, 0, 0]) * (1 if camera else -1)
        return replace(seen, image=(seen.image + red).clamp(0, 1))

    longer = replace(SETTINGS, texture=Schedule(steps=40, batch=4, lr=3e-3))
    image_loss = trained_losses(tmp_path, settings=longer, shown=material(redder))
    change = image_loss.correction.change - image_loss.correction.change.mean(dim=0)
    assert change[1, 0].sum() > 0.01
    assert change[1, 0].sum() > 3 * change[1, 1:].sum(dim=1).abs().max()


def brightness(image_loss: ImageLoss, shown: Material, *, drawn: bool) -> float:
    """How much brighter the second camera's first image is than the first one's, on the mean of the person."""
    sides = []
    for camera in range(CAMERAS):
        seen = shown.views.see(0, camera)
        image = (
            torch.as_tensor(picture_of(image_loss.teacher, shown.windows[0], seen))
            if drawn
            else seen.over(torch.ones(3))
        )
        sides.append(float(((image - 1).mean(dim=2) * seen.mask).sum() / seen.mask.sum()))
    return sides[1] - sides[0]


def test_sun_from_one_side_stays_in_the_teacher(tmp_path: Path) -> None:
    """Cameras that are alike stand on both sides: what differs is the light, not the cameras."""
    shown = material(sun=0.5)
    longer = replace(SETTINGS, texture=Schedule(steps=25, batch=4, lr=2e-2))
    image_loss = trained_losses(tmp_path, settings=longer, shown=shown)
    wanted = brightness(image_loss, shown, drawn=False)
    assert abs(wanted) > 0.05
    assert brightness(image_loss, shown, drawn=True) == pytest.approx(wanted, rel=0.15)


def test_without_colour_correction_cameras_are_alike(tmp_path: Path) -> None:
    def darker(seen: Seen, camera: int) -> Seen:
        return replace(seen, image=seen.image * (0.8 if camera else 1))

    shown = material(darker)
    settings = replace(SETTINGS, texture=Schedule(steps=25, batch=4, lr=2e-2), colour_correction=False)
    image_loss = trained_losses(tmp_path, settings=settings, shown=shown)
    assert not image_loss.correction.change.any()
    wanted = brightness(image_loss, shown, drawn=False)
    assert brightness(image_loss, shown, drawn=True) == pytest.approx(wanted, rel=0.25)


@torch.no_grad()
def test_a_view_that_is_not_trusted_counts_as_little_as_it_weighs() -> None:
    def loss(weight: float) -> float:
        shown = material(lambda seen, camera: replace(seen, weight=weight))
        torch.manual_seed(0)
        return float(ImageLoss(teacher(), shown, SETTINGS)(torch.tensor([0]), torch.ones(1, 3)))

    whole, half, none = (loss(weight) for weight in (1.0, 0.5, 0.0))
    assert whole > none + 0.01
    assert half == pytest.approx((whole + none) / 2, rel=1e-5)


def test_the_teacher_keeps_the_mean_look(tmp_path: Path) -> None:
    image_loss = trained_losses(tmp_path)
    assert image_loss.looks.any()
    torch.testing.assert_close(image_loss.teacher.look, image_loss.looks.mean(dim=0))


SHOWN = [2 * frame for frame in range(FRAMES)]  # frames of the clip that `material` shows
WINDOWS = [[frame] * 3 for frame in SHOWN]  # poses that are refined, where those before a frame do not matter


def refinement(most: float, windows: Sequence[list[int]] = WINDOWS) -> PoseRefinement:
    clip = synthetic_avatar().clips[0]
    poses = torch.from_numpy(clip.rotations[windows]), torch.from_numpy(clip.translations[windows])
    return PoseRefinement(subject().rig.skeleton, *poses, most=most)


def test_unrefined_poses_are_those_of_the_clip() -> None:
    clip, skeleton = synthetic_avatar().clips[0], subject().rig.skeleton
    wanted = skeleton.skinning(clip.rotations, clip.translations)
    found = refinement(3.0, [list(range(len(clip)))])(0).detach().numpy()
    np.testing.assert_allclose(found, wanted, rtol=0, atol=60 * float(np.finfo(np.float32).eps))


def away(poses: PoseRefinement) -> float:
    """Degrees by which joint 1 is turned in the first frame."""
    with torch.no_grad():
        turned, straight = (own(0)[0, 1, :4] for own in (poses, refinement(3.0)))
    return 2 * float(torch.rad2deg(torch.asin((turned - straight).norm() / 2))) * 2


def test_poses_are_turned_to_fit_the_pictures(tmp_path: Path) -> None:
    poses = refinement(3.0)
    with torch.no_grad():
        poses.turns[0, 1] = 1.0  # the images show what is not turned
    before = away(poses)
    assert 3 < before < 3 * 3**0.5
    shown = material()
    settings = replace(SETTINGS, texture=Schedule(steps=12, batch=6, lr=1e-3, cosine=False), code=0)
    image_loss = ImageLoss(teacher(settings), shown, settings, refinement=poses)
    train_teacher(image_loss, shown, settings, run=run_in(tmp_path))
    assert away(poses) < 0.9 * before


def test_a_figure_that_stands_beside_its_pictures_is_moved_back() -> None:
    """The move equals the error of the given poses; in the first and last frame, folds look like a part of it."""
    clip, skeleton = synthetic_avatar().clips[0], subject().rig.skeleton
    off = torch.tensor([[0.02, -0.01, 0.015], [-0.015, 0.02, 0.01], [0.01, 0.01, -0.02]])
    shifted = torch.from_numpy(clip.translations[WINDOWS]).float()
    shifted[:, :, skeleton.root] += off[:, None]
    poses = PoseRefinement(skeleton, torch.from_numpy(clip.rotations[WINDOWS]), shifted, most=4.0)
    shown = material()
    settings = replace(SETTINGS, code=0)
    image_loss = ImageLoss(teacher(settings), shown, settings, refinement=poses)
    with torch.no_grad():
        image_loss.teacher.mean.copy_(looks_of_pictures(image_loss.teacher))
    optimizer = torch.optim.Adam([poses.moves], lr=0.1)
    for _ in range(30):
        optimizer.zero_grad()
        image_loss(torch.arange(FRAMES * CAMERAS), torch.zeros(FRAMES * CAMERAS, 3)).backward()
        optimizer.step()
    left = off + torch.tanh(poses.moves.detach()) * poses.farthest
    share = left.norm(dim=1) / off.norm(dim=1)
    assert share[1] < 0.1
    assert (share < 0.6).all()
    with torch.no_grad():
        window = image_loss.window(0)
        torch.testing.assert_close(window.root, motion()[0].root + left[0], rtol=0, atol=1e-5)


def test_a_refined_window_is_that_of_the_refined_poses() -> None:
    """The root's heading too, which the networks of folds remove."""
    clip, own = synthetic_avatar().clips[0], subject()
    poses = refinement(3.0, [[0] * 3, [2, 1, 0], [4, 3, 2]])
    skeleton = own.rig.skeleton
    with torch.no_grad():
        poses.turns[:, skeleton.root, 1] = 1.0
        poses.moves.fill_(0.5)
        turn = torch.tanh(torch.tensor(1.0, dtype=torch.float64)) * poses.most / 2
        moved = torch.tanh(torch.tensor(0.5, dtype=torch.float64)) * poses.farthest
    turned, translations = clip.rotations.copy(), clip.translations.copy()
    half = np.array([1.0, 0, float(turn), 0]) / np.hypot(1, float(turn))
    turned[:, skeleton.root] = rotation.multiply(clip.rotations[:, skeleton.root], half)
    translations[:, skeleton.root] += float(moved)
    wanted = windows(skeleton, own.encoding, replace(clip, rotations=turned, translations=translations))[4]
    settings = replace(SETTINGS, code=0)
    shown = material()
    with torch.no_grad():
        found = ImageLoss(teacher(settings), shown, settings, refinement=poses).window(2)
    tolerance = 60 * float(np.finfo(np.float32).eps)
    for name in ("joints", "root", "back"):
        torch.testing.assert_close(getattr(found, name), getattr(wanted, name), rtol=0, atol=tolerance)
    assert (wanted.back - motion()[4].back).abs().max() > 0.01


def test_who_is_upside_down_has_no_heading() -> None:
    poses = refinement(3.0)
    joints = poses(0)[0].detach()
    joints[poses.root, :4] = torch.tensor([0.0, 0.6, 0, 0.8])
    assert poses.back(joints).tolist() == [1, 0, 0, 0]


def test_the_root_is_moved_no_farther_than_is_allowed() -> None:
    poses, straight = refinement(3.0), refinement(3.0)
    with torch.no_grad():
        poses.moves.fill_(100.0)
        away = poses.place(poses(0)[0]) - straight.place(straight(0)[0])
    torch.testing.assert_close(away, torch.full((3,), 0.03), rtol=0, atol=1e-5)
    assert poses.size() > 0


def test_views_of_a_batch_are_cameras_of_few_frames() -> None:
    views = Views(FRAMES * 10, CAMERAS * 3, lambda frame, camera: pytest.fail("nothing is seen yet"))
    rows = views.draw(6, torch.Generator().manual_seed(0))
    assert len(rows) == len(set(rows.tolist())) == 6
    assert len({row // views.cameras for row in rows.tolist()}) <= 3
    assert len(Views(5, 1, views.see).draw(4, torch.Generator())) == 4


def test_every_view_can_be_drawn() -> None:
    views = Views(3, 4, lambda frame, camera: pytest.fail("nothing is seen yet"))
    generator = torch.Generator().manual_seed(0)
    assert {row for _ in range(60) for row in views.draw(4, generator).tolist()} == set(range(12))


def test_a_batch_shows_two_views_of_a_frame() -> None:
    views = Views(1000, 4, lambda frame, camera: pytest.fail("nothing is seen yet"))
    rows = views.draw(8, torch.Generator().manual_seed(0))
    frames, times = (rows // 4).unique(return_counts=True)
    assert (len(frames), times.tolist()) == (4, [2] * 4)


def test_all_that_is_trained_beside_the_mean_texture_has_a_rate() -> None:
    shown = material()
    image_loss = ImageLoss(teacher(), shown, SETTINGS, refinement=refinement(3.0))
    rates = {id(parameter): rate for parameters, rate in _rates(image_loss) for parameter in parameters}
    wanted = {name: id(parameter) for name, parameter in image_loss.named_parameters() if name != "teacher.mean"}
    assert set(rates) == set(wanted.values())
    assert rates[wanted["teacher.still"]] == 60 * rates[wanted["looks"]]
    assert rates[wanted["refinement.turns"]] == rates[wanted["refinement.moves"]] == 100 * rates[wanted["looks"]]


@torch.no_grad()
def test_a_picture_of_the_empty_set_takes_the_place_of_a_drawn_background() -> None:
    def losses(shown: Material) -> list[float]:
        image_loss = ImageLoss(teacher(), shown, SETTINGS)
        return [float(image_loss(torch.tensor([0]), torch.full((1, 3), light))) for light in (0.0, 0.7)]

    def before_grey(seen: Seen, camera: int) -> Seen:
        return replace(seen, background=torch.full_like(seen.image, 0.7))

    of_set, drawn = losses(material(before_grey)), losses(material())
    assert of_set[0] == of_set[1] == pytest.approx(drawn[1], rel=1e-6)
    assert drawn[0] != pytest.approx(drawn[1], rel=1e-3)


def test_a_frame_trains_its_own_look_alone() -> None:
    image_loss = ImageLoss(teacher(), material(), SETTINGS)
    with torch.no_grad():
        for parameter in image_loss.teacher.nets.parameters():
            parameter.add_(0.1 * torch.randn(parameter.shape, generator=torch.Generator().manual_seed(2)))
    image_loss(torch.tensor([CAMERAS]), torch.ones(1, 3)).backward()
    assert image_loss.looks.grad is not None
    assert image_loss.looks.grad[1].any()
    assert not image_loss.looks.grad[[0, 2]].any()


def test_what_is_added_to_colours_costs_nothing_of_itself() -> None:
    """Only what moves or reshapes splats is held near nothing."""
    image_loss = ImageLoss(
        teacher(), material(), replace(SETTINGS, weights=LossWeights(l1=0, ssim=0, alpha=0, residual=1))
    )
    last = image_loss.teacher.nets.appearance.last.bias
    with torch.no_grad():
        last.fill_(0.5)  # type: ignore[union-attr]
        assert float(image_loss(torch.tensor([0]), torch.ones(1, 3))) == 0
        image_loss.teacher.nets.geometry.last.bias.fill_(0.5)  # type: ignore[union-attr]
        assert float(image_loss(torch.tensor([0]), torch.ones(1, 3))) == pytest.approx(0.25, rel=0.01)


def test_a_texel_that_no_image_shows_is_drawn_to_the_colour_of_its_neighbours() -> None:
    alone = LossWeights(l1=0, ssim=0, alpha=0, residual=0)
    image_loss = ImageLoss(teacher(), material(), replace(SETTINGS, weights=alone))
    mean, (one, other) = image_loss.teacher.mean, image_loss.teacher.nets.surface.neighbours
    with torch.no_grad():
        mean[one[0]] = 1.0
    image_loss(torch.tensor([0]), torch.ones(1, 3), False).backward()
    assert mean.grad is not None
    assert (mean.grad[one[0]] > 0).all()
    assert (mean.grad[other[0]] < 0).all()


@torch.no_grad()
def test_what_all_cameras_share_is_no_cameras_own_colour() -> None:
    image = torch.rand(4, 5, 4, generator=torch.Generator().manual_seed(0))
    correction = ColourCorrection(2)
    correction.change[:, 0, 0] = 0.3
    torch.testing.assert_close(correction(image, 1), image)
    correction.change[1, 0, 3] = 0.2  # of what is covered alone
    wanted = image.clone()
    wanted[..., 0] += 0.1 * image[..., 3]
    torch.testing.assert_close(correction(image, 1), wanted)


@torch.no_grad()
def test_no_residual_is_so_large_that_a_splat_is_lost_for_good() -> None:
    own = teacher()
    own.nets.geometry.last.bias.fill_(1e6)  # type: ignore[union-attr]
    assert own(motion()[0]).added.max() == pytest.approx(MOST_RESIDUAL)


def test_a_larger_figure_has_larger_offsets() -> None:
    rig = subject().rig
    larger = replace(rig, mesh=replace(rig.mesh, vertices=3 * rig.mesh.vertices))
    small, large = (TeacherModel(replace(subject(), rig=own), SETTINGS).nets.units for own in (rig, larger))
    torch.testing.assert_close(large[:3], 3 * small[:3])
    torch.testing.assert_close(large[3:], small[3:])
