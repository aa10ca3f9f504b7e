"""Images by gsplat, whose CUDA kernels a plain stand-in of its documented arguments replaces here."""

import sys
from pathlib import Path
from types import ModuleType

import pytest
import torch
from captures import make_capture
from commands import Commands
from small_teachers import FEW
from torch_splats import camera, in_torch, random_splats

from mua.splatting.gsplat_views import gsplat_views, intrinsics
from mua.splatting.projection import Eye, matrices
from mua.splatting.rasterise import rasterise
from mua.teachers.trained import settings
from mua.teachers.trained.model import draw_views

LEAST_DB = 33.0  # of Gaussians at pixel centres beside windows over pixels; a flipped axis leaves 17


def rasterization(
    means: torch.Tensor,  # [N, 3]
    quats: torch.Tensor,  # [N, 4] wxyz
    scales: torch.Tensor,  # [N, 3]
    opacities: torch.Tensor,  # [N]
    colors: torch.Tensor,  # [N, 3]
    viewmats: torch.Tensor,  # [C, 4, 4] OpenCV's
    Ks: torch.Tensor,  # [C, 3, 3]
    width: int,
    height: int,
    *,
    near_plane: float,
    eps2d: float,
    rasterize_mode: str,
) -> tuple[torch.Tensor, torch.Tensor, dict[str, torch.Tensor]]:
    """What https://docs.gsplat.studio/main/apis/rasterization.html describes, splat after splat."""
    assert rasterize_mode == "antialiased"
    (view,), (focal,) = viewmats, Ks
    at = means @ view[:3, :3].T + view[:3, 3]
    image, left = torch.zeros(height, width, 3).to(at), torch.ones(height, width).to(at)
    rows, columns = torch.meshgrid(torch.arange(height) + 0.5, torch.arange(width) + 0.5, indexing="ij")
    for n in torch.argsort(at[:, 2]).tolist():
        x, y, z = at[n]
        if z < near_plane:
            continue
        jacobian = torch.stack(
            [
                torch.stack([focal[0, 0] / z, torch.zeros_like(z), -focal[0, 0] * x / z**2]),
                torch.stack([torch.zeros_like(z), focal[1, 1] / z, -focal[1, 1] * y / z**2]),
            ]
        )
        axes = jacobian @ view[:3, :3] @ (matrices(quats[n]) * scales[n])
        thin = axes @ axes.T
        wide = thin + eps2d * torch.eye(2).to(at)
        middle = (focal @ at[n] / z)[:2]
        away = torch.stack([columns, rows], dim=-1).to(at) - middle
        power = (away @ wide.inverse() * away).sum(dim=-1) / 2
        alpha = opacities[n] * (thin.det() / wide.det()).sqrt() * torch.exp(-power)
        alpha = torch.where(alpha < 1 / 255, 0, alpha)
        image = image + (left * alpha)[..., None] * colors[n]
        left = left * (1 - alpha)
    return image[None], (1 - left)[None, ..., None], {}


@pytest.fixture
def stand_in(monkeypatch: pytest.MonkeyPatch) -> None:
    module = ModuleType("gsplat")
    module.rasterization = rasterization  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "gsplat", module)


def decibels(one: torch.Tensor, other: torch.Tensor) -> float:
    return float(-10 * (one - other).square().mean().log10())


@pytest.mark.usefixtures("stand_in")
def test_gsplat_draws_what_our_rasteriser_draws() -> None:
    numbers = random_splats(60)
    splats = in_torch(numbers)
    eye = Eye.of(camera(), splats.centres)
    (drawn,) = gsplat_views(splats, [eye])
    own = rasterise(splats, eye, torch.tensor(numbers.bounds))
    assert drawn.shape == own.shape
    assert decibels(drawn, own) > LEAST_DB


@pytest.mark.usefixtures("stand_in")
def test_training_views_are_drawn_by_the_rasteriser_asked_for() -> None:
    splats = in_torch(random_splats(20))
    eyes = [Eye.of(camera(screen), splats.centres) for screen in ((20, 16), (12, 24))]
    by_gsplat = draw_views(splats, eyes, by="gsplat")
    own = draw_views(splats, eyes)
    assert [picture.shape for picture in by_gsplat] == [picture.shape for picture in own]
    assert all(torch.equal(a, b) for a, b in zip(by_gsplat, gsplat_views(splats, eyes), strict=True))
    assert not torch.equal(by_gsplat[0], own[0])


def test_a_shifted_principal_point_is_kept() -> None:
    eye = Eye.of(camera(), torch.zeros(1, dtype=torch.float64))
    shifted = eye.projection.clone()
    shifted[0, 2], shifted[1, 2] = 0.2, -0.1
    point = torch.tensor([0.3, -0.2, -2.0, 1.0], dtype=torch.float64)  # of the eye, Y up
    clip = shifted @ point
    width, height = eye.screen
    column, row = (clip[0] / clip[3] + 1) * width / 2, (1 - clip[1] / clip[3]) * height / 2
    opencv = intrinsics(Eye(eye.view, shifted, eye.screen)) @ (point[:3] * torch.tensor([1.0, -1, -1]))
    torch.testing.assert_close(opencv[:2] / opencv[2], torch.stack([column, row]))


def test_reports_that_gsplat_is_not_installed(
    tmp_path: Path, command: Commands, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(settings.PRESETS, "tiny", FEW)  # it would take long, were it to begin
    line = ("teach", make_capture(tmp_path / "capture").folder, "-o", tmp_path / "t", "--steps", 1, "--texels", 64)
    said = command(*line, "--rasteriser", "gsplat").sentence
    assert "--rasteriser gsplat: the Python package gsplat is not installed; pip install gsplat" in said


def test_rejects_gsplat_without_a_gpu(
    tmp_path: Path, command: Commands, stand_in: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("mua.baking.teach.find_spec", lambda name: name)
    folder = make_capture(tmp_path / "capture").folder
    said = command("teach", folder, "--rasteriser", "gsplat", "--device", "cpu", "-o", tmp_path / "t").sentence
    assert "--rasteriser gsplat: draws on NVIDIA GPUs only, and the device is cpu" in said
