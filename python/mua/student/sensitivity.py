"""How much each sample of the subbands changes images, the weight of its errors in fine-tuning.

An image of random signs, carried back through drawing and posing, holds on average the squared length of each sample's
derivative: one backward pass measures all samples (Bekas et al. 2007, https://doi.org/10.1016/j.apnum.2007.01.003).
"""

import time

import numpy as np
import torch
from torch import Tensor

from mua.avatar.camera import orbit
from mua.avatar.decode import box_of
from mua.channels import ATTRIBUTES
from mua.recording import RecordedClip, Recording
from mua.splatting.posing import TorchRig, pose_splats
from mua.splatting.projection import Eye
from mua.splatting.rasterise import rasterise
from mua.student.model import lowpass_texels
from mua.training.optimise import Progress, Run
from mua.wavelets import Bands

STAGE = "picture sensitivities"
SIDE = 256  # pixels along a side of an image
HIGHEST = 0.4  # radians, from which cameras look down, or up
GOLDEN = np.pi * (3 - np.sqrt(5))  # radians from one camera to the next
LEAST = 1e-3  # share of an attribute's mean square: other images may show samples that these do not


def measure_sensitivities(recording: Recording, pictures: int, run: Run) -> Bands:
    """By how much, root mean square over pixels, a unit of each sample changes images of training frames.

    Values are for one frame; the three bands of a detail level share theirs, [1, 1, 23, n, n]. Frames are evenly
    spaced, the cameras around them.
    """
    rows = torch.linspace(0, recording.count() - 1, pictures).long()
    mean = torch.from_numpy(recording.mean_texture()).float().to(run.device)
    middle = Bands(*(band.mean(0).to(run.device) for band in recording.subbands(slice(0, len(mean.T)), rows)))
    rig = TorchRig.of(recording.rig, mean)
    places = [(clip, frame) for clip in recording.clips if not clip.held_out for frame in clip.recorded]
    total = Bands(*(torch.zeros_like(band) for band in middle))
    started = time.monotonic()
    for number, row in enumerate(rows.tolist(), start=1):
        azimuth = float(GOLDEN * number)
        elevation = HIGHEST * (2 * number - 1 - pictures) / pictures
        squares = _squares(
            recording, rig, row, places[row], (azimuth, elevation), mean=mean, middle=middle, generator=run.generator
        )
        total = Bands(*(one + other for one, other in zip(total, squares, strict=True)))
        run.report(Progress(STAGE, number, pictures, None, number / (time.monotonic() - started)))
    coarse = (total.ll + total.d3.sum(0)) / 4
    ll, d2 = (shared_pattern(band / pictures).sqrt()[None] for band in (coarse, total.d2.mean(0)))
    return Bands(ll, ll[:, None], d2[:, None])


def _squares(
    recording: Recording,
    rig: TorchRig,
    row: int,  # index among the training frames
    place: tuple[RecordedClip, int],  # its clip and frame
    direction: tuple[float, float],  # azimuth and elevation of the camera, radians
    *,
    mean: Tensor,  # [N, 23] texture
    middle: Bands,  # [23, n, n], ... subbands of the mean texture
    generator: torch.Generator,
) -> Bands:
    """The squared derivatives of one image, [23, n, n], [3, 23, n, n] and [3, 23, 2n, 2n]."""
    clip, frame = place
    channels = slice(0, mean.shape[1])
    away = [
        (band[0].to(mean) - own).requires_grad_()
        for band, own in zip(recording.subbands(channels, [row]), middle, strict=True)
    ]
    bands = Bands(*(band[None] for band in away))
    texels = torch.from_numpy(recording.rig.texels.texels).long().to(mean.device)
    texture = lowpass_texels(bands, recording.wavelet, texels)[0].T + mean
    pose = clip.pose(frame)
    joints = torch.from_numpy(recording.rig.skeleton.skinning(pose.rotations, pose.translations)).to(mean)
    mesh = torch.from_numpy(recording.meshes([row])[0]).to(mean)
    splats = pose_splats(rig, joints, mesh, texture)
    box = box_of(splats.centres.detach().cpu().numpy())
    camera = orbit(box, screen=(SIDE, SIDE), azimuth=direction[0], elevation=direction[1])
    picture = rasterise(splats, Eye.of(camera, mean), torch.from_numpy(box).to(mean), torch.zeros(3).to(mean))
    signs = 2 * torch.randint(2, picture.shape, generator=generator).to(mean) - 1
    (picture * signs).sum().div(np.sqrt(picture.numel())).backward()
    return Bands(*(band.grad.square() for band in away if band.grad is not None))


def shared_pattern(
    squares: Tensor,  # [23, h, w] by channel and sample
) -> Tensor:
    """Sensitivities with one pattern over samples for all channels of an attribute, which are visible together."""
    shared = torch.empty_like(squares)
    for own in ATTRIBUTES.values():
        pattern = squares[own].mean(0)
        pattern = pattern / pattern.mean().clamp(min=torch.finfo(pattern.dtype).tiny)
        shared[own] = squares[own].mean((1, 2))[:, None, None] * pattern.clamp(min=LEAST)
    return shared
