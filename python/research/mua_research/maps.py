"""Position and normal textures of the posed coarse mesh, what the convolutional systems read (paper, Ablations)."""

import torch
from torch import Tensor
from torch.nn import functional

from mua.rig.rig import Rig
from mua.rig.texel_map import build_texel_map
from mua.texture.fill import Fill

CHANNELS = 6  # position 3, normal 3


class SurfaceMaps:
    """The maps of one rig at one resolution; empty texels are filled as those of the Gaussian textures are."""

    def __init__(self, rig: Rig, size: int, *, device: torch.device) -> None:
        """Raises InputError where no texel centre of `size` x `size` lies on the surface."""
        texels = build_texel_map(rig.mesh, size)
        self.size = size
        self._fill = Fill(texels)
        self._faces = torch.as_tensor(rig.mesh.faces, dtype=torch.long, device=device)
        self._corners = self._faces[torch.as_tensor(texels.triangles, dtype=torch.long, device=device)]
        self._barycentrics = torch.as_tensor(texels.barycentrics, dtype=torch.float32, device=device)

    def __call__(
        self,
        posed: Tensor,  # [F, V, 3] metres
    ) -> Tensor:
        """Positions (metres) and unit normals [F, 6, n, n]."""
        both = torch.cat([posed, vertex_normals(posed, self._faces)], dim=2)
        at_texels = torch.einsum("nk,fnkc->nfc", self._barycentrics, both[:, self._corners])
        at_texels[..., 3:] = functional.normalize(at_texels[..., 3:], dim=-1)
        images = self._fill(at_texels.flatten(1).cpu()).to(posed.device)
        return images.unflatten(0, (len(posed), CHANNELS))


def vertex_normals(
    vertices: Tensor,  # [F, V, 3]
    faces: Tensor,  # [T, 3]
) -> Tensor:
    """Unit normals [F, V, 3], faces weighted by area; zero where they cancel."""
    a, b, c = (vertices[:, corner] for corner in faces.T)
    crossed = torch.linalg.cross(b - a, c - a)
    total = torch.zeros_like(vertices)
    for corner in faces.T:
        total.index_add_(1, corner, crossed)
    return functional.normalize(total, dim=-1)
