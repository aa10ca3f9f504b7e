"""A small capture on disk, as users have them: the procedural character, drawn as splats by the reference renderer."""

import io
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
from gltf_files import Glb
from PIL import Image

from mua.arrays import Array
from mua.capture import Capture, CaptureCamera, CaptureClip, write_capture
from mua.decode import Splats, pose_splats
from mua.export.bvh import bvh_text
from mua.pose.clip import Clip
from mua.rendering import render_premultiplied, to_bytes
from mua.rig.character import Character
from mua.teachers.procedural import procedural_character
from mua.teachers.still import StillTeacher

SIDE = 64  # pixels
RATE = 30.0
TEXELS = 96
FRAMES = {"walk": 4, "reach": 2}  # of clips; the last is held out
STRIDE = {"walk": 4, "reach": 20}  # frames of the character's own clips from one frame of the capture to the next
MIDDLE = np.array([0.0, 0.85, 0.0])  # of the figure, metres
DISTANCE = 3.2  # of the cameras, metres
ANGLES = {"front": 0.1, "left": 1.8, "right": 4.0, "above": 5.4}  # radians round the figure; the last is held out
RISES = {"front": 0.0, "left": -0.1, "right": 0.15, "above": 0.5}  # radians; a level camera's rotation is its inverse


def make_capture(folder: Path, *, distortion: tuple[float, ...] = (0.0,) * 5) -> Capture:
    """Write the capture; images have the figure's alpha as their masks. The same bytes for the same arguments.

    With `distortion`, capture.json says so, but images are those of a pinhole.
    """
    character = _character()
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "template.glb").write_bytes(_character_file())
    for name, clip in motions().items():
        (folder / f"{name}.bvh").write_text(bvh_text(character.skeleton, clip))
    capture = Capture(
        folder=folder,
        name="figure",
        rate=RATE,
        template=folder / "template.glb",
        cameras=tuple(replace(camera, distortion=distortion) for camera in ring()),
        clips=tuple(
            CaptureClip(name, folder / f"{name}.bvh", 1, frames, held_out=name == "reach")
            for name, frames in FRAMES.items()
        ),
        images="images/{clip}/{camera}/{frame:06d}.png",
    )
    write_capture(capture)
    for (clip, frame, camera), picture in _pictures().items():
        place = capture.place(capture.images, clip=clip, camera=camera, frame=frame)
        place.parent.mkdir(parents=True, exist_ok=True)
        Image.fromarray(picture).save(place)
    return capture


def ring() -> list[CaptureCamera]:
    """Cameras round the figure, their principal points off the middle of their images."""
    return [
        CaptureCamera(
            name=name,
            size=(SIDE, SIDE),
            focal=(92.0, 90.0),
            centre=(SIDE / 2 + 2, SIDE / 2 - 1),
            world_to_camera=looking(MIDDLE + DISTANCE * _direction(angle, RISES[name]), MIDDLE),
            held_out=name == "above",
        )
        for name, angle in ANGLES.items()
    ]


def looking(position: Array, target: Array) -> Array:
    """World to camera [4, 4], OpenCV's axes, upright."""
    forward = (target - position) / np.linalg.norm(target - position)
    right = np.cross(forward, [0, 1.0, 0])
    right /= np.linalg.norm(right)
    matrix = np.eye(4)
    matrix[:3, :3] = [right, np.cross(forward, right), forward]
    matrix[:3, 3] = -matrix[:3, :3] @ position
    return matrix


def _direction(azimuth: float, elevation: float) -> Array:
    level = np.cos(elevation)
    return np.array([level * np.sin(azimuth), np.sin(elevation), level * np.cos(azimuth)])


@cache
def _character() -> Character:
    return procedural_character()


@cache
def motions() -> dict[str, Clip]:
    """Clips whose first pose is not filmed: frame 0 shows pose 1."""
    own = {clip.name: clip for clip in _character().clips}
    return {name: own[name].cut(np.arange(frames + 1) * STRIDE[name]) for name, frames in FRAMES.items()}


@cache
def _pictures() -> dict[tuple[str, int, str], Array]:
    """Images [H, W, 4] uint8, their colours not premultiplied, by clip, frame and camera."""
    teacher = StillTeacher(_character(), texels=TEXELS, template_vertices=500)
    return {
        (name, frame, camera.name): drawn(_splats(teacher, clip, frame + 1), camera)
        for name, clip in motions().items()
        for frame in range(FRAMES[name])
        for camera in ring()
    }


def _splats(teacher: StillTeacher, clip: Clip, frame: int) -> Splats:
    shown = teacher.frame(clip.pose(frame))
    return pose_splats(teacher.rig, shown.mesh, texture=shown.texture, pose=shown.pose)


def drawn(splats: Splats, camera: CaptureCamera) -> Array:
    """An image [H, W, 4] uint8."""
    image = render_premultiplied(splats, camera.camera())
    color = image[..., :3] / np.maximum(image[..., 3:], 1 / 255)
    return to_bytes(np.concatenate([color, image[..., 3:]], axis=-1))


@cache
def _character_file() -> bytes:
    return character_file(_character())


def character_file(character: Character) -> bytes:
    """A character whose joints are not turned in the bind pose as a .glb: mesh, skin and texture, no animation."""
    skeleton, mesh, glb = character.skeleton, character.mesh, Glb()
    assert (skeleton.bind_rotations == [1, 0, 0, 0]).all()
    glb.json["nodes"] = [
        {"name": name, "translation": at.tolist(), "children": np.flatnonzero(skeleton.parents == j).tolist()}
        for j, (name, at) in enumerate(zip(skeleton.names, skeleton.bind_translations, strict=True))
    ]
    for node in glb.json["nodes"]:
        if not node["children"]:
            del node["children"]
    _, places = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    binds = np.tile(np.eye(4), (len(places), 1, 1))
    binds[:, :3, 3] = -places
    glb.json["skins"] = [
        {"joints": list(range(len(places))), "inverseBindMatrices": glb.accessor(binds.swapaxes(1, 2))}
    ]
    pairs, corners = np.unique(
        np.stack([mesh.faces.ravel(), mesh.uv_faces.ravel()], axis=1), axis=0, return_inverse=True
    )
    vertex, uv = pairs.T
    attributes = {"POSITION": glb.accessor(mesh.vertices[vertex]), "TEXCOORD_0": glb.accessor(mesh.uv[uv])}
    for k in range(2):
        influences = slice(4 * k, 4 * k + 4)
        attributes[f"JOINTS_{k}"] = glb.accessor(character.skin_indices[vertex, influences], "u1")
        attributes[f"WEIGHTS_{k}"] = glb.accessor(character.skin_weights[vertex, influences])
    content = io.BytesIO()
    Image.fromarray(character.base_color).save(content, "png")
    glb.json["images"] = [{"bufferView": glb.view(content.getvalue()), "mimeType": "image/png"}]
    glb.json["textures"] = [{"source": 0}]
    glb.json["materials"] = [{"name": "figure", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]
    primitive = {"attributes": attributes, "indices": glb.accessor(corners.reshape(-1), "u4"), "material": 0}
    glb.json["meshes"] = [{"name": "figure", "primitives": [primitive]}]
    glb.json["nodes"].append({"name": "figure", "mesh": 0, "skin": 0})
    glb.json["scenes"] = [{"nodes": [0, len(places)]}]
    return glb.content()
