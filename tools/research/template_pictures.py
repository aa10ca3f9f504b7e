"""Images of meshes for measurements of the template: lit from the viewer, red where they are wrong."""

import numpy as np
import torch

from mua.arrays import Array
from mua.avatar.camera import orbit
from mua.channels import SH_C0
from mua.rig.character import Mesh
from mua.splatting.projection import Eye, TorchSplats
from mua.splatting.rasterise import rasterise
from mua.teachers.trained.mesh_losses import Samples
from mua.teachers.trained.silhouette import SPREAD, facing

SIZE = (420, 760)  # pixels
DISCS = 60_000
WORST = 0.02  # metres; red


def picture_of(
    vertices: Array,  # [V, 3] world, metres
    faces: Array,  # [F, 3]
    *,
    errors: Array,  # [V] metres
    about: Array,  # [W, 3] what is framed
) -> Array:
    """[H, W, 3] uint8."""
    mesh = Mesh(vertices, faces, np.zeros((1, 2)), np.zeros_like(faces))
    samples = Samples.of(mesh, DISCS)
    centres, normals = samples.on(torch.tensor(vertices))
    camera = orbit(np.stack([about.min(axis=0), about.max(axis=0)]), screen=SIZE, azimuth=0.6, elevation=0.1)
    toward = torch.nn.functional.normalize(torch.tensor(camera.position) - centres, dim=1)
    shade = (normals * toward).sum(1, keepdim=True).clamp(0, 1)
    corners = torch.tensor(errors)[samples.corners]
    wrong = ((samples.barycentrics * corners).sum(1, keepdim=True) / WORST).clamp(0, 1)
    grey, red = torch.tensor([0.85, 0.85, 0.85]), torch.tensor([0.9, 0.1, 0.1])
    colours = (0.2 + 0.7 * shade) * ((1 - wrong) * grey + wrong * red)
    sh = torch.zeros(DISCS, 12, dtype=torch.float64)
    sh[:, :3] = (colours - 0.5) / SH_C0
    wide = SPREAD * samples.spacing
    scales = torch.tensor([wide, wide, 0.1 * wide]).double().expand(DISCS, 3)
    splats = TorchSplats(centres, facing(normals), scales, torch.full((DISCS,), 0.99).double(), sh, facing(normals))
    bounds = torch.stack([centres.amin(dim=0), centres.amax(dim=0)])
    image = rasterise(splats, Eye.of(camera, centres), bounds, torch.ones(3, dtype=torch.float64))
    return np.asarray((image.clamp(0, 1) * 255).round().to(torch.uint8))
