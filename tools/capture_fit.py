"""How well the true surfaces of a capture fit its images: whether cameras, frames and surfaces belong together."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image

from mua.arrays import Array
from mua.capture import Capture
from mua.fidelity.canvas import opened
from mua.fidelity.painter import Painter
from mua.scene import Material, Part

FRAMES = 3  # compared frames of each clip: first, middle and last


@dataclass(frozen=True)
class Fit:
    """Distances between the edges of surface and image, pixels."""

    mean: float
    worst: float
    pictures: int
    where: str  # the image with the worst


def measure_fit(capture: Capture) -> Fit:
    """Draw the true surfaces of some frames over all cameras' images; needs OpenGL."""
    with np.load(capture.folder / "render" / "surface.npz") as held:
        faces, uv = held["faces"], held["uv"].reshape(-1, 2)
    texture = np.asarray(Image.open(capture.folder / "render" / "texture.png"))
    apart: dict[Path, float] = {}
    with opened() as context:
        painter = Painter(context, [_part(faces, uv)], [Material("surface", texture)], screen=capture.cameras[0].size)
        for clip in capture.clips:
            for frame in sorted({0, clip.frames // 2, clip.frames - 1}):
                places = read_vertices(capture.place(str(capture.meshes), clip=clip.name, frame=frame))
                for camera in capture.cameras:
                    file = capture.place(capture.images, clip=clip.name, camera=camera.name, frame=frame)
                    mask = np.asarray(Image.open(file))[..., 3] / 255
                    apart[file] = edge_distance(painter([places], camera.camera())[..., 3], mask)
    worst = max(apart, key=lambda file: apart[file])
    return Fit(float(np.mean(list(apart.values()))), apart[worst], len(apart), str(worst))


def edge_distance(
    one: Array,  # [H, W] coverage, 0..1
    other: Array,  # [H, W]
) -> float:
    """The mean distance in pixels between two silhouettes' edges: the area between them over the edges' length."""
    length = np.hypot(*np.gradient(one)).sum()
    return float(np.abs(one - other).sum() / length) if length else float("inf")


def read_vertices(file: Path) -> Array:
    """The vertices [V, 3] of a surface that the tool wrote."""
    content = file.read_bytes()
    header, _, rest = content.partition(b"end_header\n")
    count = int(header.split(b"element vertex ")[1].split()[0])
    return np.frombuffer(rest, "<f4", 3 * count).reshape(-1, 3)


def _part(faces: Array, uv: Array) -> Part:
    corners = np.arange(3 * len(faces)).reshape(-1, 3)
    vertices = int(faces.max()) + 1
    return Part(
        name="surface",
        group=0,
        positions=np.zeros((vertices, 3)),
        faces=faces,
        uv=uv,
        uv_faces=corners,
        material=0,
        skin=0,
        joints=np.zeros((vertices, 1), int),
        weights=np.ones((vertices, 1)),
    )
