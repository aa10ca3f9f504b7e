"""The teacher itself: a rest texture on the drivable template, and the networks that add what motion changes."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import torch
from torch import Tensor, nn

from mua.channels import SH_C0
from mua.pose.encoding import PoseEncoding
from mua.rig.bones import figure_scale
from mua.rig.rig import Rig
from mua.splatting.gsplat_views import gsplat_views
from mua.splatting.posing import TorchRig, pose_splats
from mua.splatting.projection import Eye, TorchSplats
from mua.splatting.rasterise import rasterise_views
from mua.teachers.trained.drivable_template import DrivableTemplate
from mua.teachers.trained.light import Light
from mua.teachers.trained.settings import Rasteriser, TeacherSettings
from mua.teachers.trained.template_training import TemplateSettings, template_of
from mua.teachers.trained.texels import TexelNets
from mua.teachers.trained.windows import Window

CONSTANT = slice(11, 14)  # channels of a splat's colour from everywhere
MOST_RESIDUAL = 20.0  # largest output of a network, in units: a splat cannot move where no image shows it any more


@dataclass(frozen=True, eq=False)
class Subject:
    """The person that a teacher is trained for: the rig, and the surfels of its character's own textures."""

    rig: Rig
    surfels: Tensor  # [N, 23] raw channels in the bind pose
    encoding: PoseEncoding  # of the motion descriptors


class Frame(NamedTuple):
    """The teacher's output for one pose."""

    canonical: Tensor  # [V, 3] metres
    texture: Tensor  # [N, 23] raw channels
    added: Tensor  # [N, 23] what the networks add, in units
    posed: Tensor  # [V, 3] the template in the world, metres


class TeacherModel(nn.Module):
    """All that a trained teacher needs for frames of any motion."""

    surfels: Tensor  # [N, 23]
    look: Tensor  # [code] the mean over training frames

    def __init__(self, subject: Subject, settings: TeacherSettings) -> None:
        super().__init__()
        rig = subject.rig
        self.rig = rig
        self.register_buffer("surfels", subject.surfels.float())
        self.register_buffer("look", torch.zeros(settings.code))
        drivable = settings.drivable
        self.template = template_of(rig, subject.encoding, TemplateSettings()) if drivable else DrivableTemplate(rig)
        self.mean = nn.Parameter(torch.zeros(len(rig.texels.texels), 3))  # of the colour, in display values
        self.still = nn.Parameter(torch.zeros_like(self.surfels))  # what the networks' mean adds, in units
        self.light = Light()
        self.nets = TexelNets(
            rig,
            window=settings.window,
            channels=settings.channels,
            levels=settings.levels,
            code=settings.code,
            size=figure_scale(rig.mesh.vertices),
        )
        self._torch_rig: TorchRig | None = None

    def forward(
        self,
        window: Window,
        *,
        look: Tensor | None = None,  # [code] of the frame; the mean of all if left out
        moving: bool = True,  # False: only the mean texture on the skinned template
    ) -> Frame:
        template = self.template(window.descriptors, window.joints)
        mean = self.mean_texture()
        if not moving:
            return Frame(template.canonical[0], mean, torch.zeros_like(mean), template.posed[0])
        added = self.nets(template.posed, window.root, window.back, self.look if look is None else look)
        added = MOST_RESIDUAL * torch.tanh(added / MOST_RESIDUAL)
        texture = self._lit(mean + (self.still + added) * self.nets.units, template.posed[0])
        return Frame(template.canonical[0], texture, added, template.posed[0])

    def _lit(self, texture: Tensor, posed: Tensor) -> Tensor:
        """The texture [N, 23] with its colours in the light that falls on the posed template [V, 3]."""
        colours = 0.5 + SH_C0 * texture[:, CONSTANT]
        lit = (colours * self.light(self.nets.surface.facing(posed)) - 0.5) / SH_C0
        return torch.cat([texture[:, : CONSTANT.start], lit, texture[:, CONSTANT.stop :]], dim=1)

    def mean_texture(self) -> Tensor:
        """[N, 23] the surfels in the mean colours of the images."""
        colours = self.surfels[:, CONSTANT] + self.mean / SH_C0
        return torch.cat([self.surfels[:, : CONSTANT.start], colours, self.surfels[:, CONSTANT.stop :]], dim=1)

    def splats(self, frame: Frame, joints: Tensor) -> TorchSplats:
        """The frame posed by its joints [J, 8]."""
        if self._torch_rig is None or self._torch_rig.corners.device != joints.device:
            self._torch_rig = TorchRig.of(self.rig, joints)
        return pose_splats(self._torch_rig, joints, frame.canonical, frame.texture)


def draw(splats: TorchSplats, eye: Eye) -> Tensor:
    """Premultiplied sRGB and alpha [H, W, 4]."""
    return draw_views(splats, [eye])[0]


def draw_views(splats: TorchSplats, eyes: Sequence[Eye], *, by: Rasteriser = "mua") -> list[Tensor]:
    """Premultiplied sRGB and alpha [H, W, 4] of several cameras."""
    if by == "gsplat":
        return gsplat_views(splats, eyes)
    bounds = torch.stack([splats.centres.amin(dim=0), splats.centres.amax(dim=0)]).detach()
    return rasterise_views(splats, eyes, bounds)
