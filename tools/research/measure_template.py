"""Fit the drivable template to the simulated surface of a character; print how far skinning and each network are off.

python tools/research/measure_template.py White_F_3_Casual.glb --motion cmu/ --held-out 02_02 --held-out 02_09

Distances are those of points all over the template from the true surface, and of its vertices from where the simulation
moved the same vertices: mean / 95 %, millimetres.
"""

import argparse
import tempfile
import time
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import torch
from PIL import Image
from template_pictures import picture_of
from torch import Tensor

import mua.cli  # noqa: F401 first of all: it sets how torch's threads wait
from mua.arrays import Array
from mua.baking.sources import load_character, load_clips
from mua.files.write import replacing
from mua.pose.descriptor import choose_joints, choose_translated, describe
from mua.pose.encoding import PoseEncoding
from mua.rig.build import build_rig
from mua.rig.character import Character, Mesh
from mua.rig.moving import moving_joints
from mua.rig.rig import Rig
from mua.teachers.simulated.simulated_surface import SimulatedSurface
from mua.teachers.trained.drivable_template import DrivableTemplate
from mua.teachers.trained.mesh_losses import Cloud, Samples
from mua.teachers.trained.motion_deformation import GraphSizes, MotionDeformation
from mua.teachers.trained.template_training import Observed, TemplateSettings, fit_template, template_of, training_run
from mua.training.optimise import Progress

POINTS = 20_000  # points of a true surface, in training
MEASURED = 60_000  # where distances are measured
COMPARED = 10_000  # points of the template
LONGEST = 360  # frames of a clip


@dataclass(frozen=True, eq=False)
class Frames:
    """Frames of one or more clips, and the true surface in each."""

    descriptors: Tensor  # [F, D]
    joints: Tensor  # [F, J, 8]
    surfaces: Array  # [F, W, 3] float32 dense vertices, world


@dataclass(frozen=True, eq=False)
class Seen:
    """The frames as the training sees them."""

    frames: Frames
    mesh: Mesh

    @property
    def descriptors(self) -> Tensor:
        return self.frames.descriptors

    @property
    def joints(self) -> Tensor:
        return self.frames.joints

    def observe(self, frame: int, generator: torch.Generator) -> Observed:
        surface = self.frames.surfaces[frame]
        return Observed(cloud=Cloud.of(replace(self.mesh, vertices=surface.astype(float)), POINTS))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("character", nargs="?", type=Path, help="none: the procedural character")
    parser.add_argument("--motion", type=Path, action="append", default=[])
    parser.add_argument("--held-out", action="append", default=[], help="name of a clip")
    parser.add_argument("--every", type=int, default=2, help="frames from one that is used to the next")
    parser.add_argument("--nodes", type=int, default=GraphSizes.nodes)
    parser.add_argument("--steps", type=float, default=1.0, help="times the preset's")
    parser.add_argument("--surfaces", type=Path, default=Path(tempfile.gettempdir()) / "mua-surfaces", help="kept here")
    parser.add_argument("--picture", type=Path)
    arguments = parser.parse_args()
    character = load_character(arguments.character, uv="auto", seed=0)
    clips = [clip.cut(slice(0, LONGEST)) for clip in load_clips(character, arguments.motion, mapping=None)[0]]
    rig, source = build_rig(character, texels=64)
    used = moving_joints(rig)
    training = [clip for clip in clips if clip.name not in arguments.held_out]
    encoding = PoseEncoding(
        choose_joints(rig.skeleton, training, used),
        rate=clips[0].rate,
        translated=choose_translated(rig.skeleton, training, used),
    )
    parts = {}
    for clip in clips:
        name = arguments.surfaces / f"{character.name}-{clip.name}-{len(clip)}-{arguments.every}.npy"
        if not name.exists():
            found = SimulatedSurface(character).frames(clip)
            kept = [one.places for number, one in enumerate(found) if number % arguments.every == 0]
            with replacing(name) as temporary:
                np.save(temporary, np.array(kept, np.float32))
        rows = np.arange(0, len(clip), arguments.every)
        described = describe(rig.skeleton, encoding, clip.rotations, clip.translations)[rows]
        joints = rig.skeleton.skinning(clip.rotations, clip.translations)[rows]
        parts[clip.name] = Frames(torch.tensor(described).float(), torch.tensor(joints).float(), np.load(name))
    learnt = joined([parts[clip.name] for clip in training])
    seen = Seen(learnt, character.mesh)
    template, spent = trained(seen, rig, encoding, arguments)
    print(
        f"{character.name}: {len(learnt.joints)} training frames, {len(rig.mesh.vertices)} vertices, {spent:.0f} s CPU"
    )
    shown = {"training": every(learnt, 8), **{name: every(parts[name], 4) for name in arguments.held_out}}
    report(template, rig, shown, character, source)
    if arguments.picture:
        last = parts[arguments.held_out[-1]] if arguments.held_out else learnt
        draw(template, rig, last, character, arguments.picture)


def joined(frames: list[Frames]) -> Frames:
    return Frames(
        torch.cat([one.descriptors for one in frames]),
        torch.cat([one.joints for one in frames]),
        np.concatenate([one.surfaces for one in frames]),
    )


def every(frames: Frames, step: int) -> Frames:
    return Frames(frames.descriptors[::step], frames.joints[::step], frames.surfaces[::step])


def trained(
    seen: Seen, rig: Rig, encoding: PoseEncoding, arguments: argparse.Namespace
) -> tuple[DrivableTemplate, float]:
    settings = TemplateSettings(sizes=GraphSizes(nodes=arguments.nodes))
    of_nodes, of_offsets = (
        replace(one, steps=max(1, int(one.steps * arguments.steps))) for one in (settings.nodes, settings.offsets)
    )
    settings = replace(settings, nodes=of_nodes, offsets=of_offsets)
    template = template_of(rig, encoding, settings)
    print("parameters", sum(parameter.numel() for parameter in template.parameters()))
    started = time.process_time()
    with tempfile.TemporaryDirectory() as directory:
        run = training_run(seen, rig, encoding, settings, directory=Path(directory), report=print_some)
        fit_template(template, seen, rig, settings, run=run)
    return template, time.process_time() - started


def print_some(progress: Progress) -> None:
    if progress.step % 100 == 0:
        print(f"{progress.stage} {progress.step} of {progress.steps}: {progress.loss:.4f}", flush=True)


@torch.no_grad()
def vertices_of(template: DrivableTemplate, frames: Frames, rig: Rig) -> dict[str, Array]:
    """Posed vertices [F, V, 3] by each of the systems."""
    deformation = template.deformation
    assert isinstance(deformation, MotionDeformation)
    found: dict[str, list[Tensor]] = {"skinned": [], "F_eg": [], "F_eg + F_delta": []}
    rest = deformation.graph.vertices
    for descriptors, joints in zip(frames.descriptors.split(16), frames.joints.split(16), strict=True):
        canonical = {
            "skinned": rest.expand(len(joints), -1, -1),
            "F_eg": deformation.deform(descriptors, offsets=False).vertices,
            "F_eg + F_delta": deformation.deform(descriptors).vertices,
        }
        for name, vertices in canonical.items():
            found[name].append(template.pose(vertices, joints).posed)
    return {name: torch.cat(posed).double().numpy() for name, posed in found.items()}


def report(template: DrivableTemplate, rig: Rig, shown: dict[str, Frames], character: Character, source: Array) -> None:
    samples = Samples.of(rig.mesh, COMPARED)
    for name, frames in shown.items():
        clouds = [
            Cloud.of(replace(character.mesh, vertices=surface.astype(float)), MEASURED) for surface in frames.surfaces
        ]
        for system, posed in vertices_of(template, frames, rig).items():
            points = [samples.on(torch.tensor(own))[0].numpy() for own in posed]
            across = 1000 * np.concatenate([distance(*pair) for pair in zip(points, clouds, strict=True)])
            away = 1000 * np.linalg.norm(posed - frames.surfaces[:, source], axis=2)
            print(
                f"| {name} | {system} | {across.mean():.2f} / {np.quantile(across, 0.95):.1f} "
                f"| {away.mean():.2f} / {np.quantile(away, 0.95):.1f} |",
                flush=True,
            )


def distance(points: Array, cloud: Cloud) -> Array:
    """From points [V, 3] to the plane of the surface at its nearest point, metres."""
    from scipy.spatial import cKDTree

    _, nearest = cKDTree(cloud.points).query(points)
    return np.abs(np.sum((points - cloud.points[nearest]) * cloud.normals[nearest], axis=1))


def draw(template: DrivableTemplate, rig: Rig, frames: Frames, character: Character, path: Path) -> None:
    """The skinned, the fitted and the true surface in the middle frame, lit from the front, coloured by distance."""
    middle = every(frames, max(len(frames.joints) // 2, 1))
    middle = Frames(middle.descriptors[1:2], middle.joints[1:2], middle.surfaces[1:2])
    surface = middle.surfaces[0].astype(float)
    cloud = Cloud.of(replace(character.mesh, vertices=surface), MEASURED)
    views = []
    for posed in vertices_of(template, middle, rig).values():
        views.append(picture_of(posed[0], rig.mesh.faces, errors=distance(posed[0], cloud), about=surface))
    views.append(picture_of(surface, character.mesh.faces, errors=np.zeros(len(surface)), about=surface))
    Image.fromarray(np.concatenate(views, axis=1)).save(path)


if __name__ == "__main__":
    main()
