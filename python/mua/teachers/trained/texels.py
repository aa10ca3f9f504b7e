"""Motion-aware Gaussian texels: two UNets over position and normal textures (paper, Sec. Teacher Model).

E_geo reads the posed template turned back by the heading, because folds do not depend on where a person faces; E_app
reads it as it stands in the world, because light does.
"""

import torch
from torch import Tensor, nn
from torch.nn import functional

from mua.channels import APPEARANCE, CHANNELS, GEOMETRY
from mua.rig.rig import Rig
from mua.splatting.posing import rotate
from mua.teachers.trained.unet import UNet

GEOMETRY_INPUTS = 6  # of each pose of a window: position and normal
# What an output of 1 adds to a channel: to offsets (metres on a person), quaternions, log scales, opacity and SH.
UNITS = ((0.01,) * 3, (0.05,) * 4, (0.1,) * 3, (0.5,), (0.2,) * 3, (0.1,) * 9)


class SurfaceTextures(nn.Module):
    """The surface of the posed template by texel."""

    corners: Tensor  # [N, 3] vertices about each texel
    barycentrics: Tensor  # [N, 3]
    faces: Tensor  # [F, 3]
    texels: Tensor  # [N] row * size + column
    neighbours: Tensor  # [2, P] texels of each pair that lie side by side or one above the other

    def __init__(self, rig: Rig) -> None:
        super().__init__()
        self.size = rig.texels.size
        held = {
            "corners": torch.as_tensor(rig.mesh.faces[rig.texels.triangles]).long(),
            "barycentrics": torch.as_tensor(rig.texels.barycentrics).float(),
            "faces": torch.as_tensor(rig.mesh.faces).long(),
            "texels": torch.as_tensor(rig.texels.texels).long(),
        }
        held["neighbours"] = neighbours(held["texels"], self.size)
        for name, tensor in held.items():
            self.register_buffer(name, tensor, persistent=False)

    def roughness(
        self,
        values: Tensor,  # [N, C] at the valid texels
    ) -> Tensor:
        """The mean squared difference between texels that lie side by side in the texture."""
        one, other = values[self.neighbours]
        return (one - other).square().mean() if len(one) else values.new_zeros(())

    def forward(
        self,
        posed: Tensor,  # [k, V, 3] metres, about the root
    ) -> Tensor:
        """Images [1, 6 k, S, S] of positions and normals, 0 where no texel is valid."""
        surface = torch.cat([posed, normals(posed, self.faces)], dim=2)
        values = torch.einsum("nc,kncd->kdn", self.barycentrics, surface[:, self.corners])
        return self.image(values.flatten(0, 1))[None]

    def facing(
        self,
        posed: Tensor,  # [V, 3]
    ) -> Tensor:
        """Unit normals [N, 3] at the valid texels."""
        corners = normals(posed, self.faces)[self.corners]
        return functional.normalize(torch.einsum("nc,ncd->nd", self.barycentrics, corners), dim=-1, eps=1e-12)

    def image(
        self,
        values: Tensor,  # [C, N] at the valid texels
    ) -> Tensor:
        """Images [C, S, S]."""
        whole = values.new_zeros(len(values), self.size**2)
        return whole.index_copy(1, self.texels, values).view(-1, self.size, self.size)

    def at_texels(
        self,
        image: Tensor,  # [C, S, S]
    ) -> Tensor:
        """Values [N, C] at the valid texels."""
        return image.flatten(1)[:, self.texels].T


class TexelNets(nn.Module):
    """Networks from the posed template to what its motion adds to raw channels."""

    units: Tensor  # [23]

    def __init__(self, rig: Rig, *, window: int, channels: int, levels: int, code: int, size: float) -> None:
        """`size` is that of the figure over a person's, `code` the number of values in a frame's look."""
        super().__init__()
        self.surface = SurfaceTextures(rig)
        sizes = {"channels": channels, "levels": levels}
        self.geometry = UNet(GEOMETRY_INPUTS * window, GEOMETRY.stop, **sizes)
        self.appearance = UNet(GEOMETRY_INPUTS * window + code, CHANNELS - APPEARANCE.start, **sizes)
        units = torch.tensor([unit for units in UNITS for unit in units])
        units[:3] *= size
        self.register_buffer("units", units)

    def forward(
        self,
        posed: Tensor,  # [k, V, 3] world, newest first, metres
        root: Tensor,  # [3] of the newest pose, world
        back: Tensor,  # [4] the rotation that removes its heading
        code: Tensor,  # [code] its look
    ) -> Tensor:
        """Residuals [N, 23] in `units`."""
        about = posed - root
        turned = self.surface(rotate(back.expand(*about.shape[:2], 4), about))
        upright = self.surface(about)
        looks = code.view(1, -1, 1, 1).expand(-1, -1, *upright.shape[2:])
        images = self.geometry(turned), self.appearance(torch.cat([upright, looks], dim=1))
        return self.surface.at_texels(torch.cat(images, dim=1)[0])


def neighbours(
    texels: Tensor,  # [N] row * size + column
    size: int,
) -> Tensor:
    """Indices [2, P] into `texels` of each pair that lies side by side or one above the other."""
    at = torch.full((size * size,), -1, dtype=torch.long)
    at[texels] = torch.arange(len(texels))
    grid = at.view(size, size)
    pairs = [torch.stack([grid[:, :-1], grid[:, 1:]]), torch.stack([grid[:-1], grid[1:]])]
    flat = torch.cat([pair.flatten(1) for pair in pairs], dim=1)
    return flat[:, (flat >= 0).all(dim=0)]


def normals(
    vertices: Tensor,  # [..., V, 3]
    faces: Tensor,  # [F, 3]
) -> Tensor:
    """Unit normals [..., V, 3], faces weighted by area; 0 where they cancel."""
    a, b, c = (vertices[..., faces[:, corner], :] for corner in range(3))
    across = torch.linalg.cross(b - a, c - a)
    total = torch.zeros_like(vertices)
    for corner in range(3):
        total = total.index_add(-2, faces[:, corner], across)
    return functional.normalize(total, dim=-1, eps=1e-12)
