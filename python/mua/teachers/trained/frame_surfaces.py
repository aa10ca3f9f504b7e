"""The surfaces of a capture's frames, on which the drivable template is trained."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from pathlib import Path

import numpy as np
import torch
import trimesh
from torch import Tensor

from mua import rotation
from mua.arrays import Array
from mua.errors import InputError
from mua.kernels.dq_skinning import blend_vertices
from mua.rig.bones import figure_scale
from mua.rig.character import Mesh
from mua.teachers.trained.from_capture import Filmed
from mua.teachers.trained.mesh_losses import Cloud
from mua.teachers.trained.template_training import Observed

POINTS = 20_000  # of a surface
UNITS = (1.0, 1e-3)  # metres: surfaces of a capture may be in millimetres
ALIKE = 2.0  # times as large or small as the posed template a surface may be
KEPT = 256  # surfaces in memory, 2 MB each with its tree; of longer captures, some are read anew


@dataclass(frozen=True, eq=False)
class MeasuredSurfaces:
    """The training frames of a capture with meshes."""

    descriptors: Tensor  # [F, D]
    joints: Tensor  # [F, J, 8]
    files: tuple[Path, ...]  # [F]
    size: float  # of the figure over that of a person
    unit: float = 1.0  # metres, of the files

    def observe(self, frame: int, generator: torch.Generator) -> Observed:
        return Observed(cloud=self._cloud(frame))

    @cached_property
    def _cloud(self) -> Callable[[int], Cloud]:
        """Clouds of frames, cached: reading a surface takes longer than comparing the template with it."""
        return lru_cache(KEPT)(lambda frame: Cloud.of(self._surface(frame), POINTS, size=self.size))

    def _surface(self, frame: int) -> Mesh:
        surface = read_surface(self.files[frame])
        return replace(surface, vertices=self.unit * surface.vertices)


def measured_surfaces(filmed: Filmed) -> MeasuredSurfaces | None:
    """The surfaces of all training frames; None where the capture has none. Raises InputError where one is missing."""
    pattern, rig = filmed.capture.meshes, filmed.subject.rig
    if pattern is None:
        return None
    frames = [(clip.name, frame) for clip in filmed.clips for frame in range(len(clip))]
    files = tuple(filmed.capture.place(pattern, clip=clip, frame=frame) for clip, frame in frames)
    missing = next((file for file in files if not file.is_file()), None)
    if missing is not None:
        raise InputError(f"{missing}: there is no such file; capture.json names a mesh for every frame")
    windows = [window for clip in filmed.clips for window in filmed.windows(clip)]
    duals = blend_vertices(windows[0].joints[0].double().numpy(), rig.skin_indices, rig.skin_weights)
    return MeasuredSurfaces(
        torch.stack([window.descriptors[0] for window in windows]),
        torch.stack([window.joints[0] for window in windows]),
        files,
        figure_scale(rig.mesh.vertices),
        unit_of(files[0], rotation.dual_transform(duals, rig.mesh.vertices)),
    )


def unit_of(
    file: Path,
    template: Array,  # [V, 3] posed as in the same frame, metres
) -> float:
    """The unit of a surface in metres: it is about as large as the template and lies where that does.

    Raises InputError where that holds neither in metres nor in millimetres.
    """
    (low, high), (first, last) = (
        (points.min(axis=0), points.max(axis=0)) for points in (read_surface(file).vertices, template)
    )
    size, wanted = float((high - low).max()), float((last - first).max())
    for unit in UNITS:
        apart = np.linalg.norm(unit * (low + high) - (first + last)) / 2
        if wanted / ALIKE < unit * size < ALIKE * wanted and apart < wanted:
            return unit
    raise InputError(
        f"{file}: the surface is {size:.3g} long, its middle is at {np.round((low + high) / 2, 2).tolist()}; the posed "
        f"template is {wanted:.3g} m, at {np.round((first + last) / 2, 2).tolist()}: expected metres or millimetres in "
        "the world of the cameras"
    )


def read_surface(file: Path) -> Mesh:
    """The triangles of a .ply or .obj file, in the file's unit; raises InputError where it holds none."""
    try:
        held = trimesh.load_mesh(file, process=False, skip_materials=True)
        vertices, faces = np.array(held.vertices, float), np.array(held.faces, np.int64)
    except Exception as error:  # trimesh lets pass whatever its parsers run into
        raise InputError(f"{file}: is no .ply or .obj file with vertices and triangles ({error})") from error
    if not faces.size or not np.isfinite(vertices).all():
        raise InputError(f"{file}: expected triangles between finite vertices")
    wrong = faces[(faces < 0) | (faces >= len(vertices))]
    if wrong.size:
        raise InputError(f"{file}: a face names vertex {wrong[0]}; there are {len(vertices)}")
    return Mesh(vertices, faces, np.zeros((1, 2)), np.zeros_like(faces))
