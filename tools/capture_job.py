"""All of a virtual capture but its images: template, motion, true surfaces, cameras, and the renderer's job."""

import json
import shutil
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
from capture_fit import read_vertices
from PIL import Image
from scipy.spatial import ConvexHull
from virtual_studio import Run, chosen_runs, held_back, on_the_spot, ring

from mua.arrays import Array
from mua.baking.sources import load_clips
from mua.capture import Capture, CaptureClip, write_capture
from mua.characters.figure_size import FigureSize
from mua.characters.read import read_character
from mua.errors import InputError
from mua.export.character_glb import motion_glb
from mua.files.write import replacing, write_bytes
from mua.motion.load import unique_names
from mua.pose.clip import Clip
from mua.pose.encoding import RATE
from mua.rig.character import Character
from mua.rig.surface_points import interpolate, spread_points
from mua.teachers.simulated.simulated_surface import SimulatedSurface
from mua.teachers.simulated.skinned_surface import SkinnedSurface

ATLAS = 2048  # texels of the rendered image of all materials along a side
IMAGES, MESHES = "images/{clip}/{camera}/{frame:06d}.png", "meshes/{clip}/{frame:06d}.ply"
TRACKS, TRACKED = "tracks/{clip}.npz", 1000  # points all over the surface that are followed
ONE_FILE = (".glb", ".vrm", ".usdc", ".usdz")  # kinds of characters that can be copied
LIGHTS = {"studio": "three soft lamps", "sun": "the sun from one side and a blue sky"}
CORNERS = np.dtype([("count", "u1"), ("vertices", "<i4", 3)])  # layout of a face of a .ply


@dataclass(frozen=True)
class Order:
    """The settings of a capture; a folder holds the capture of one order."""

    character: str
    motion: tuple[str, ...]
    held_out_motion: tuple[str, ...]
    height: float | None
    leave_out: tuple[str, ...]
    cameras: int
    held_out_cameras: int
    size: int
    frames: int
    held_out_frames: int
    samples: int
    light: str  # a key of LIGHTS
    seed: int
    still: bool


@dataclass(frozen=True)
class Filmed:
    """Clips of motion, and which frames of them are in the capture."""

    clips: list[Clip]
    runs: list[Run]
    held_out: list[bool]  # for each run


def job_file(folder: Path) -> Path:
    """The renderer's job file; it is written after everything but the images."""
    return folder / "render" / "job.json"


def prepare(order: Order, folder: Path) -> None:
    """Write all of a capture but its images, and last the job that makes them."""
    path = Path(order.character)
    size = FigureSize(height=order.height)
    character = read_character(path, "auto", atlas_size=ATLAS, size=size, leave_out=order.leave_out)
    filmed = film(order, character)
    clips = write_motions(folder, character, filmed)
    outline = write_meshes(order, folder, character, filmed, clips)
    write_tracks(folder, character, clips)
    capture = Capture(
        folder=folder,
        name=character.name,
        rate=RATE,
        template=copy_template(path, folder),
        template_height=order.height,
        leave_out=order.leave_out,
        cameras=ring(
            outline,
            cameras=order.cameras,
            held_out=order.held_out_cameras,
            size=order.size,
            rng=np.random.default_rng(order.seed),
        ),
        clips=tuple(clips),
        images=IMAGES,
        meshes=MESHES,
        tracks=TRACKS,
    )
    write_capture(capture)
    write_job(order, capture, character, outline)


def film(order: Order, character: Character) -> Filmed:
    """Choose the frames: of the held-out motion, or where none is named of the last clip, or of the end of the only."""
    seen, _ = load_clips(character, [Path(name) for name in order.motion], mapping=None)
    unseen: list[Clip] = []
    if order.held_out_motion:
        unseen, _ = load_clips(character, [Path(name) for name in order.held_out_motion], mapping=None)
    clips = unique_names([on_the_spot(clip, character.skeleton) for clip in (*seen, *unseen)])
    training, held = held_back([len(clip) for clip in clips], named=len(unseen), frames=order.held_out_frames)
    training, held = chosen_runs(training, order.frames), chosen_runs(held, order.held_out_frames)
    if not training:
        raise InputError(f"{order.character}: no frame of its motion is left to train on; give longer motion")
    return Filmed(clips, [*training, *held], [False] * len(training) + [True] * len(held))


def write_motions(folder: Path, character: Character, filmed: Filmed) -> list[CaptureClip]:
    """Write every clip on the character's own skeleton; a clip of the capture for each run."""
    made = []
    for run, held in zip(filmed.runs, filmed.held_out, strict=True):
        clip = filmed.clips[run.clip]
        name = "".join(c if c.isalnum() or c in "-_" else "_" for c in clip.name)
        motion = folder / "motion" / f"{run.clip:02d}_{name}.glb"
        if not motion.exists():
            write_bytes(motion, motion_glb(character.skeleton, clip))
        made.append(CaptureClip(f"{run.clip:02d}_{name}_{run.first:04d}", motion, run.first, run.frames, held))
    return made


def write_meshes(
    order: Order, folder: Path, character: Character, filmed: Filmed, clips: Sequence[CaptureClip]
) -> Array:
    """Move the surface through every clip and write it at the chosen frames; the corners [N, 3] of all hulls."""
    surface = SkinnedSurface(character) if order.still else SimulatedSurface(character, seed=order.seed)
    corners = []
    for i, clip in enumerate(filmed.clips):
        wanted = {
            run.first + k: folder / MESHES.format(clip=made.name, frame=k)
            for run, made in zip(filmed.runs, clips, strict=True)
            for k in range(run.frames)
            if run.clip == i
        }
        moving = surface.frames(clip.cut(slice(max(wanted, default=-1) + 1)))
        for frame, moved in enumerate(moving):
            if frame in wanted:
                write_bytes(wanted[frame], mesh_ply(moved.places, character.mesh.faces))
                corners.append(moved.places[ConvexHull(moved.places).vertices])
        print(f"moved {clip.name}: {len(wanted)} of {len(clip)} frames are filmed", flush=True)
    return np.concatenate(corners)


def write_tracks(folder: Path, character: Character, clips: Sequence[CaptureClip]) -> None:
    """Write where points of the surface truly are in all frames of each clip; all are seen."""
    mesh = character.mesh
    triangles, barycentrics = spread_points(mesh, TRACKED)
    corners = mesh.faces[triangles]
    for clip in clips:
        surfaces = (read_vertices(folder / MESHES.format(clip=clip.name, frame=k)) for k in range(clip.frames))
        points = np.stack([interpolate(surface, corners, barycentrics) for surface in surfaces])
        with replacing(folder / TRACKS.format(clip=clip.name)) as temporary, temporary.open("wb") as file:
            np.savez(file, points=points.astype(np.float32), bind=interpolate(mesh.vertices, corners, barycentrics))


def mesh_ply(vertices: Array, faces: Array) -> bytes:
    """The content of a .ply with a surface."""
    lines = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertices)}"]
    lines += [f"property float {axis}" for axis in "xyz"]
    lines += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header\n"]
    rows = np.empty(len(faces), CORNERS)
    rows["count"], rows["vertices"] = 3, faces
    return "\n".join(lines).encode() + vertices.astype("<f4").tobytes() + rows.tobytes()


def copy_template(character: Path, folder: Path) -> Path:
    """The character in the folder where it is one file, else where it lies with the files that it needs."""
    if character.suffix.lower() not in ONE_FILE:
        return character
    copied = folder / f"template{character.suffix.lower()}"
    with replacing(copied) as temporary:
        shutil.copyfile(character, temporary)
    return copied


def write_job(order: Order, capture: Capture, character: Character, outline: Array) -> None:
    """Write what tools/cycles_render.py reads: surface, texture, and the list of images in the order of the clips."""
    mesh, place = character.mesh, job_file(capture.folder)
    with replacing(place.with_name("surface.npz")) as temporary:
        np.savez(temporary, faces=mesh.faces, uv=mesh.uv[mesh.uv_faces])
    with replacing(place.with_name("texture.png")) as temporary:
        Image.fromarray(character.base_color).save(temporary)
    job = {
        "order": asdict(order),
        "figure": {
            "middle": (outline.min(axis=0) / 2 + outline.max(axis=0) / 2).tolist(),
            "size": float(np.ptp(outline, axis=0).max()),
        },
        "size": order.size,
        "samples": order.samples,
        "unlit": False,
        "cameras": [
            {
                "name": camera.name,
                "focal": camera.focal[0],
                "centre": camera.centre,
                "world_to_camera": camera.world_to_camera.tolist(),
            }
            for camera in capture.cameras
        ],
        "pictures": pictures(capture, order.seed),
    }
    write_bytes(place, (json.dumps(job, indent=1) + "\n").encode())


def pictures(capture: Capture, seed: int) -> list[dict[str, str | int]]:
    """Surface, camera, file and seed of every image, all cameras of a frame after each other."""
    rows: list[dict[str, str | int]] = []
    for clip in capture.clips:
        for frame in range(clip.frames):
            mesh = MESHES.format(clip=clip.name, frame=frame)
            for camera in capture.cameras:
                image = IMAGES.format(clip=clip.name, camera=camera.name, frame=frame)
                noise = seed * 1_000_003 + len(rows)  # no two images have the same
                rows.append({"mesh": f"../{mesh}", "camera": camera.name, "image": f"../{image}", "seed": noise})
    return rows
