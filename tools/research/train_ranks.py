"""Print how near students of several ranks come to their teacher, trained at full length, and what each costs.

python tools/research/train_ranks.py hero.work/recording-* [other.work/recording-*] [--points 0 4] [--device cuda]

Both branches are trained as mua-train does; the mesh is the teacher's. Errors are decibels, training and held out:
"first order" from subbands weighted by how much images change, "drawn" from images of the teacher and the student.
"""

import argparse
import sys
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import torch
from choose_ranks import costs, user_rows

import mua.cli  # noqa: F401 first of all: it sets how torch's threads wait
from mua.avatar.camera import orbit
from mua.avatar.decode import box_of
from mua.channels import APPEARANCE, CHANNELS, GEOMETRY
from mua.pose.clip import is_range
from mua.pose.descriptor import describe
from mua.recording import Recording, WholeFrame
from mua.splatting.posing import TorchRig, pose_splats
from mua.splatting.projection import Eye
from mua.splatting.rasterise import rasterise
from mua.student.distil import describe_frames, prepare
from mua.student.model import Student
from mua.student.sensitivity import measure_sensitivities
from mua.student.settings import MEASURED, PAPER_SIZES, PRESETS, Ranks, Settings, Sizes, preset
from mua.student.source import hold
from mua.student.stages import BRANCHES, fit_branch, mean_lowpass
from mua.training.checkpoint import Checkpoints, run_key
from mua.training.optimise import Progress, Run
from mua.wavelets import Bands

POINTS = (
    PAPER_SIZES,
    MEASURED,
    Sizes(Ranks(64, 128, 64), Ranks(128, 128, 128), components=128, hidden=384),
    Sizes(Ranks(32, 64, 32), Ranks(96, 128, 64), components=128, hidden=384),
    Sizes(Ranks(32, 64, 8), Ranks(64, 128, 32), components=128, hidden=384),
    Sizes(Ranks(32, 64, 8), Ranks(64, 128, 32), components=128, hidden=256),
)
KEPT = "sensitivities of images"
FRAMES, AT_ONCE = 200, 20  # of each kind whose subbands are compared, and how many of them at once
DRAWN = 16  # frames of each kind
VIEWS, SIDE, ELEVATION = (0.5, 3.4), 256, 0.1  # azimuths in radians; pixels


class Shared(Checkpoints):
    """Keeps what all students share, and nothing of one."""

    def save(self, stage: str, state: dict[str, object]) -> None:
        if stage == KEPT:
            super().save(stage, state)


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("recordings", type=Path, nargs="+")
    arguments.add_argument("--preset", choices=PRESETS, default="paper", help="of which the schedule is")
    arguments.add_argument("--points", type=int, nargs="*", default=range(len(POINTS)), help="numbers from 0 on")
    arguments.add_argument("--device", default="cpu", help="cpu or cuda")
    given = arguments.parse_args()
    print("| recording | geometry | appearance | hidden | GFLOPs | M parameters | first order | drawn |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |", flush=True)
    for path in given.recordings:
        for line in measure(Recording(path), given.preset, given.points, torch.device(given.device)):
            print("|", path.parent.stem, "|", line, flush=True)


def measure(recording: Recording, name: str, points: list[int], device: torch.device) -> Iterator[str]:
    """A row for each point."""
    settings = replace(preset(name), texels=recording.rig.texels.size, frames=recording.count())
    key = run_key((recording.fingerprint(), settings.pictures), [])
    kept = Shared(recording.directory.parent / "ranks", key)
    kept.directory.mkdir(exist_ok=True)
    run = Run(torch.Generator().manual_seed(settings.seed), kept, say, device)
    looking = run.alone(KEPT)
    tensors = looking.once(KEPT, lambda: measure_sensitivities(recording, settings.pictures, looking)._asdict())
    seen = Bands(**tensors)
    for point in (POINTS[number] for number in points):
        own = replace(settings, **vars(point))
        student = fitted(recording, own, seen, run)
        ranks = (" ".join(map(str, vars(part).values())) for part in (point.geometry, point.appearance))
        flops, parameters = costs(replace(own, texels=768)) / (1e9, 1e6)
        near = (first_order(student, recording, seen), drawn(student, recording))
        found = (" / ".join(f"{each:.2f}" for each in kinds) for kinds in near)
        yield " | ".join([*ranks, f"{point.hidden}", f"{flops:.3f}", f"{parameters:.1f}", *found]) + " |"


def fitted(recording: Recording, settings: Settings, seen: Bands, run: Run) -> Student:
    """A student with both branches trained."""
    student, samples = prepare(recording, settings)
    student.to(run.device)
    counts = None if samples.weights is None else samples.weights.to(run.device)
    inputs = student.normalize(samples.descriptors.to(run.device))
    for name, branch, channels in zip(BRANCHES, student.branches, (GEOMETRY, APPEARANCE), strict=True):
        fit_branch(
            branch,
            inputs,
            hold(samples.subbands, channels, frames=len(samples), size=student.size, device=run.device),
            channels=channels,
            components=student.components,
            settings=settings,
            name=name,
            run=run.alone(name),
            parts=samples.parts,
            sensitivities=seen,
            frames=counts,
            wavelet=student.wavelet,
        )
    student.requires_grad_(False).eval()
    low = student.mean_lowpass() if counts is None else mean_lowpass(student, samples)
    student.static.copy_(samples.mean_texture.to(run.device).T - low)
    return student


@torch.no_grad()
def first_order(student: Student, recording: Recording, seen: Bands) -> list[float]:
    """Decibels of the error that the subbands' errors make in images, of the user's frames of each kind."""
    found = []
    for held_out in (False, True):
        rows = user_rows(recording, held_out=held_out)
        rows = rows[np.linspace(0, len(rows) - 1, min(len(rows), FRAMES)).astype(int)]
        described = torch.from_numpy(describe_frames(recording, student.encoding, held_out=held_out)[rows]).float()
        error = 0.0
        for part in np.array_split(np.arange(len(rows)), max(len(rows) // AT_ONCE, 1)):
            predicted = student.predict(described[part].to(student.mean))
            truth = recording.subbands(slice(0, CHANNELS), rows[part], held_out=held_out)
            for one, other, worth in zip(predicted, truth, seen, strict=True):
                error += float(((one - other.to(one)) * worth).double().square().sum())
        found.append(-10 * np.log10(error / len(rows)))
    return found


@torch.no_grad()
def drawn(student: Student, recording: Recording) -> list[float]:
    """The mean PSNR, decibels, of the student's texture on the teacher's mesh, of the user's frames of each kind."""
    rig = TorchRig.of(recording.rig, student.static.T)
    found = []
    for held_out in (False, True):
        frames = [frame for frame in recording.whole_frames(held_out) if not is_range(frame.clip.name)]
        chosen = [frames[place] for place in np.linspace(0, len(frames) - 1, min(len(frames), DRAWN)).astype(int)]
        found.append(float(np.mean([psnr for frame in chosen for psnr in compare(student, recording, rig, frame)])))
    return found


def compare(student: Student, recording: Recording, rig: TorchRig, frame: WholeFrame) -> Iterator[float]:
    """The PSNR of each view, decibels, over black."""
    pose, to = frame.clip.pose(frame.index), partial(torch.as_tensor, dtype=torch.float32, device=student.mean.device)
    skeleton = recording.rig.skeleton
    described = describe(skeleton, student.encoding, frame.clip.rotations, frame.clip.translations)[[frame.index]]
    joints, mesh = to(skeleton.skinning(pose.rotations, pose.translations)), to(frame.mesh)
    textures = (to(frame.texture), student.texture(student.predict(to(described)))[0])
    truth, own = (pose_splats(rig, joints, mesh, texture) for texture in textures)
    box = box_of(truth.centres.cpu().numpy())
    for azimuth in VIEWS:
        eye = Eye.of(orbit(box, screen=(SIDE, SIDE), azimuth=azimuth, elevation=ELEVATION), mesh)
        one, other = (rasterise(splats, eye, to(box), to(np.zeros(3))) for splats in (truth, own))
        yield -10 * float(torch.log10((one - other).square().mean()))


def say(progress: Progress) -> None:
    if progress.step in (1, progress.steps):
        print(f"{progress.stage}: {progress.step} of {progress.steps}, {progress.rate:.1f} a second", file=sys.stderr)


if __name__ == "__main__":
    main()
