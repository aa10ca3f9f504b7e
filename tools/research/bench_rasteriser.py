"""Print what an image and its gradients take in the differentiable rasteriser, and how far it is from the reference.

python tools/research/bench_rasteriser.py hero.muaavatar [--side 256] [--device cuda [--gsplat]]: one frame of the first
clip in single precision, the median of several runs; the first compiles the kernels and is left out.
"""

import argparse
from collections.abc import Callable
from functools import partial
from pathlib import Path
from time import perf_counter

import numpy as np
import torch

from mua.asset.read import read
from mua.avatar.camera import Camera, orbit
from mua.avatar.decode import Splats, decode_clip_frame
from mua.avatar.rendering import frame_bounds, render_premultiplied
from mua.splatting.gsplat_views import gsplat_views
from mua.splatting.projection import Eye, TorchSplats, half_extents, project
from mua.splatting.rasterise import rasterise
from mua.splatting.tiles import assign

RUNS = 5


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", type=Path)
    parser.add_argument("--side", type=int, default=256, help="pixels")
    parser.add_argument("--device", default="cpu", help="cpu or cuda")
    parser.add_argument("--gsplat", action="store_true", help="also measure gsplat, which needs CUDA")
    given = parser.parse_args()
    avatar = read(given.file)
    frame = decode_clip_frame(avatar, avatar.clips[0], frame=len(avatar.clips[0]) // 2, dtype=np.float64)
    camera = orbit(frame_bounds(frame), screen=(given.side, given.side), azimuth=0.4)
    splats = on_device(frame, given.device)
    eye, bounds = Eye.of(camera, splats.centres), torch.as_tensor(frame.bounds).to(splats.centres)
    shapes = project(splats, eye, bounds).shapes.detach()
    pairs = len(assign(shapes[:, :2], half_extents(shapes), camera.screen).quads)
    print(f"{len(frame):,} splats, {given.side} x {given.side} pixels, {pairs:,} pairs of a tile and a splat")
    show_times("mua", partial(rasterise, splats, eye, bounds))
    print(f"{decibels(splats, eye, bounds, frame, camera):.0f} dB against the reference renderer in double precision")
    if given.gsplat:
        show_times("gsplat", lambda: gsplat_views(splats, [eye])[0])
        with torch.no_grad():
            error = (gsplat_views(splats, [eye])[0] - rasterise(splats, eye, bounds)).square().mean().item()
        print(f"gsplat's image is {-10 * np.log10(error):.0f} dB from ours")


def show_times(name: str, draw: Callable[[], torch.Tensor]) -> None:
    times = np.median([run(draw) for _ in range(1 + RUNS)][1:], axis=0)
    print(f"{name}: forward {times[0]:.3f} s, backward {times[1]:.3f} s")


def on_device(frame: Splats, device: str) -> TorchSplats:
    splats = TorchSplats.of(frame, device=device)
    for name, values in vars(splats).items():
        if name != "normals":
            values.requires_grad_()
    return splats


def run(draw: Callable[[], torch.Tensor]) -> tuple[float, float]:
    """Seconds forward and backward."""
    began = perf_counter()
    loss = draw().square().sum()
    loss.item()  # waits for the device
    drawn = perf_counter()
    loss.backward()
    if loss.is_cuda:
        torch.cuda.synchronize()
    return drawn - began, perf_counter() - drawn


def decibels(splats: TorchSplats, eye: Eye, bounds: torch.Tensor, frame: Splats, camera: Camera) -> float:
    with torch.no_grad():
        image = rasterise(splats, eye, bounds).double().cpu().numpy()
    return float(-10 * np.log10(np.mean((image - render_premultiplied(frame, camera)) ** 2)))


if __name__ == "__main__":
    main()
