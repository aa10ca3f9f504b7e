"""Print how near students of several sizes come to their teacher, and what each costs.

python tools/research/train_ranks.py hero.work/recording-* [other.work/recording-*] [--closed-form] [--device cuda]
python tools/research/train_ranks.py hero.work/recording-* --sizes 24,96,16/64,256,64/72/192

Both branches are trained as mua-train does; the mesh is the teacher's. PSNR between images of the teacher and the
student in decibels, training and held out.
"""

import argparse
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import torch

import mua.cli  # noqa: F401 first of all: it sets how torch's threads wait
from mua.arrays import Array
from mua.asset.count import flops, parameters
from mua.avatar.camera import orbit
from mua.avatar.decode import box_of
from mua.bench.random_avatar import ENCODING, RINGS, SPOKES
from mua.channels import APPEARANCE, CHANNELS, GEOMETRY
from mua.pose.clip import is_range
from mua.recording import Recording, WholeFrame
from mua.splatting.posing import TorchRig, pose_splats
from mua.splatting.projection import Eye
from mua.splatting.rasterise import rasterise
from mua.student.bases import BestCoefficients
from mua.student.distil import describe_frames, prepare
from mua.student.model import Student
from mua.student.sensitivity import measure_sensitivities
from mua.student.settings import LEAN_SIZES, PAPER_SIZES, PRESETS, Ranks, Settings, Sizes, StageName, preset
from mua.student.shapes import Body, outline
from mua.student.stages import BRANCHES, fit_branch, mean_lowpass
from mua.student.subband_source import hold
from mua.training.checkpoint import Checkpoints, run_key
from mua.training.optimise import Progress, Run
from mua.wavelets import Bands

BODY = Body(ENCODING.width, 3 * (9 + 6 * len(ENCODING.joints)), RINGS * SPOKES, 300_000)  # as comparisons.md counts
KEPT = "sensitivities of images"
DRAWN = 16  # frames of each kind
VIEWS, SIDE, ELEVATION = (0.5, 3.4), 256, 0.1  # azimuths in radians; pixels
Predict = Callable[[Array, bool], Bands]  # the subbands of recorded frames, by rows, of training or held out


class Shared(Checkpoints):
    """Keeps what all students share, and nothing of one."""

    def save(self, stage: str, state: dict[str, object]) -> None:
        if stage == KEPT:
            super().save(stage, state)


def main(words: Sequence[str] | None = None) -> None:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("recordings", type=Path, nargs="+")
    arguments.add_argument("--preset", choices=PRESETS, default="paper", help="of which the schedule is")
    arguments.add_argument(
        "--sizes",
        type=sizes_of,
        nargs="*",
        default=(PAPER_SIZES, LEAN_SIZES),
        help="LL,D3,D2 of geometry/LL,D3,D2 of appearance/components/hidden; those of the paper and of the presets",
    )
    arguments.add_argument("--closed-form", action="store_true", help="bases with their best coefficients, no networks")
    arguments.add_argument("--device", default="cpu", help="cpu or cuda")
    given = arguments.parse_args(words)
    print("| recording | geometry | appearance | hidden | GFLOPs | M parameters | PSNR |")
    print("| --- | --- | --- | --- | --- | --- | --- |", flush=True)
    until: StageName | None = "bases" if given.closed_form else None
    for path in given.recordings:
        for line in measure(Recording(path), given.preset, given.sizes, torch.device(given.device), until=until):
            print("|", path.parent.stem, "|", line, flush=True)


def sizes_of(text: str) -> Sizes:
    geometry, appearance, components, hidden = text.split("/")
    ranks = [Ranks(*map(int, part.split(","))) for part in (geometry, appearance)]
    return Sizes(ranks[0], ranks[1], int(components), int(hidden))


def measure(
    recording: Recording,
    name: str,
    every: Sequence[Sizes],
    device: torch.device,
    *,
    until: StageName | None = None,
) -> Iterator[str]:
    """A row for each of the sizes; until the bases, with their best coefficients."""
    settings = replace(preset(name), texels=recording.rig.texels.size, frames=recording.count())
    key = run_key((recording.fingerprint(), settings.pictures), [])
    kept = Shared(recording.directory.parent / "ranks", key)
    kept.directory.mkdir(exist_ok=True)
    run = Run(torch.Generator().manual_seed(settings.seed), kept, say, device)
    looking = run.alone(KEPT)
    tensors = looking.once(KEPT, lambda: measure_sensitivities(recording, settings.pictures, looking)._asdict())
    seen = Bands(**tensors)
    for sizes in every:
        own = replace(settings, **vars(sizes))
        student = fitted(recording, own, seen, run, until=until)
        ranks = (" ".join(map(str, vars(part).values())) for part in (sizes.geometry, sizes.appearance))
        spent, held = costs(own) / (1e9, 1e6)
        predict = by_pose(student, recording) if until is None else by_subbands(student, recording)
        near = " / ".join(f"{each:.2f}" for each in drawn(predict, student, recording))
        yield " | ".join([*ranks, f"{sizes.hidden}", f"{spent:.3f}", f"{held:.1f}", near]) + " |"


def costs(settings: Settings) -> Array:
    """Operations of a frame and parameters, at 768 texels."""
    student = outline(replace(settings, texels=768), BODY)
    spent = flops(student)
    return np.array([sum(spent.values()) - spent["components of the pose"], sum(parameters(student).values())])


def fitted(recording: Recording, settings: Settings, seen: Bands, run: Run, *, until: StageName | None) -> Student:
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
            until=until,
            sensitivities=seen,
            frames=counts,
            wavelet=student.wavelet,
        )
    student.requires_grad_(False).eval()
    low = student.mean_lowpass() if counts is None else mean_lowpass(student, samples)
    student.static.copy_(samples.mean_texture.to(run.device).T - low)
    return student


def by_pose(student: Student, recording: Recording) -> Predict:
    """What the student predicts."""
    described = [describe_frames(recording, student.encoding, held_out=kind) for kind in (False, True)]
    return lambda rows, held_out: student.predict(torch.from_numpy(described[held_out][rows]).to(student.mean))


def by_subbands(student: Student, recording: Recording) -> Predict:
    """What its bases could show: the best coefficients of the recorded subbands."""
    geometry, appearance = (BestCoefficients(branch) for branch in student.branches)

    def predict(rows: Array, held_out: bool) -> Bands:
        recorded = recording.subbands(slice(0, CHANNELS), rows, held_out=held_out)
        truth = Bands(*(band.to(student.mean) for band in recorded))
        return student.synthesize((geometry(truth.of(GEOMETRY)), appearance(truth.of(APPEARANCE))))

    return predict


@torch.no_grad()
def drawn(predict: Predict, student: Student, recording: Recording) -> list[float]:
    """The mean PSNR, decibels, of predicted textures on the teacher's mesh, of the user's frames of each kind."""
    rig = TorchRig.of(recording.rig, student.static.T)
    found = []
    for held_out in (False, True):
        clips = [clip for clip in recording.clips if clip.held_out == held_out]
        rows = {place: row for row, place in enumerate((clip.name, at) for clip in clips for at in clip.recorded)}
        frames = [frame for frame in recording.whole_frames(held_out) if not is_range(frame.clip.name)]
        chosen = [frames[place] for place in np.linspace(0, len(frames) - 1, min(len(frames), DRAWN)).astype(int)]
        shown = ((frame, predict(np.array([rows[frame.clip.name, frame.index]]), held_out)) for frame in chosen)
        found.append(float(np.mean([psnr for pair in shown for psnr in compare(student, recording, rig, *pair)])))
    return found


def compare(student: Student, recording: Recording, rig: TorchRig, frame: WholeFrame, bands: Bands) -> Iterator[float]:
    """The PSNR of each view, decibels, over black."""
    pose, to = frame.clip.pose(frame.index), partial(torch.as_tensor, dtype=torch.float32, device=student.mean.device)
    joints = to(recording.rig.skeleton.skinning(pose.rotations, pose.translations))
    mesh, textures = to(frame.mesh), (to(frame.texture), student.texture(bands)[0])
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
