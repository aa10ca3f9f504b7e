"""Train the systems of the paper's tables for as long on one recording, and set what they explain side by side.

    python tools/research/compare_systems.py RECORDING --preset tiny --seconds 40 -o build/systems.md

Share of the variance about the mean texture, by attribute, over the frames that the recording keeps whole. `mua-eval`
draws images and takes the paper's metrics; this needs no GPU.
"""

import argparse
import time
from dataclasses import replace
from itertools import groupby, islice
from pathlib import Path

import numpy as np
import torch

import mua.cli  # noqa: F401 first of all: it sets how torch's threads wait
from mua.baking.evaluate import Errors, Picture
from mua.channels import ATTRIBUTES
from mua.files.write import replacing
from mua.recording import Recording
from mua.student.settings import preset
from mua.training.checkpoint import Checkpoints, run_key
from mua.training.optimise import Run
from mua_research.motion import motion_of, training_frames
from mua_research.network import NetworkSystem
from mua_research.system import Budget, TrainingFrames
from mua_research.systems import SYSTEMS

BATCH = 16  # frames
KINDS = {"training": False, "held-out": True}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("recording", type=Path)
    parser.add_argument("--preset", default="tiny")
    parser.add_argument("--seconds", type=float, default=40, help="of training, for each system")
    parser.add_argument("--cpu", action="store_true", help="count the process's own seconds, not those of the clock")
    parser.add_argument("--systems", nargs="*", default=list(SYSTEMS), choices=list(SYSTEMS))
    parser.add_argument("--device", default="cpu", help="that the systems are trained on")
    parser.add_argument("-o", "--output", type=Path, default=Path("build/systems.md"))
    arguments = parser.parse_args()
    recording = Recording(arguments.recording)
    settings = replace(preset(arguments.preset), texels=recording.rig.texels.size)
    generator = torch.Generator().manual_seed(settings.seed)
    kept = Checkpoints(arguments.output.parent / "mesh", run_key((settings, recording.fingerprint()), []))
    run = Run(generator, kept, lambda _: None, torch.device(arguments.device))
    frames = training_frames(recording, settings, run=run)
    clock = time.process_time if arguments.cpu else time.monotonic
    budget = Budget(seconds=arguments.seconds, clock=clock)
    rows = [heading()]
    for name in arguments.systems:
        system = SYSTEMS[name](frames.sizes)
        system.fit(frames, budget, torch.Generator().manual_seed(settings.seed), lambda _: None)
        rows.append(row(system, {kind: errors(recording, frames, system, held) for kind, held in KINDS.items()}))
        print(rows[-1], flush=True)
    arguments.output.parent.mkdir(parents=True, exist_ok=True)
    with replacing(arguments.output) as temporary:
        temporary.write_text("\n".join(rows) + "\n")
    print("\n".join(rows))


def errors(recording: Recording, frames: TrainingFrames, system: NetworkSystem, held_out: bool) -> Errors:
    """Errors over the whole frames of one kind."""
    mean = Picture(frames.mean_texture.numpy(), recording.mean_mesh())
    total = Errors()
    for _, clip in groupby(recording.whole_frames(held_out), key=lambda frame: frame.clip.name):
        while batch := list(islice(clip, BATCH)):
            places = np.array([frame.index for frame in batch])
            motion = motion_of(batch[0].clip, places, rig=recording.rig, student=frames.student)
            for frame, texture in zip(batch, system.textures(motion), strict=True):
                total.add(frame, {"mean": mean, "student": Picture(texture.numpy())})
    return total


def heading() -> str:
    columns = [f"{kind} {attribute}" for kind in KINDS for attribute in ATTRIBUTES]
    titles = ["system", "s", "steps", "M parameters", "MFLOP", *columns]
    return f"| {' | '.join(titles)} |\n|{' --- |' * len(titles)}"


def row(system: NetworkSystem, kinds: dict[str, Errors]) -> str:
    shares = [f"{kinds[kind].explained(attribute):.3f}" for kind in KINDS for attribute in ATTRIBUTES]
    costs = [f"{system.parameters / 1e6:.2f}", f"{system.flops / 1e6:.1f}"]
    return f"| {' | '.join([system.name, f'{system.seconds:.0f}', str(system.steps), *costs, *shares])} |"


if __name__ == "__main__":
    main()
