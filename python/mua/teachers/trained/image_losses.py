"""The loss of a teacher's training: its images against those of the cameras (paper, Preliminaries)."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import torch
from torch import Tensor, nn

from mua.channels import ATTRIBUTES, GEOMETRY
from mua.rig.bones import figure_scale
from mua.splatting.projection import TorchSplats
from mua.splatting.ssim import structural_similarity
from mua.teachers.trained.colour_correction import ColourCorrection
from mua.teachers.trained.model import CONSTANT, Frame, TeacherModel, draw_views
from mua.teachers.trained.pose_refinement import PoseRefinement
from mua.teachers.trained.settings import TeacherSettings
from mua.teachers.trained.template_training import UNIT
from mua.teachers.trained.track_losses import TexelTracks
from mua.teachers.trained.views import Seen, Views
from mua.teachers.trained.windows import Window

Perceptual = Callable[[Tensor, Tensor], Tensor]  # of two images [1, 3, H, W] in 0..1


@dataclass(frozen=True, eq=False)
class Material:
    """Training data of a person; `windows` holds one window for each frame of `views`."""

    views: Views
    windows: Sequence[Window]
    perceptual: Perceptual | None = None
    tracks: Sequence[TexelTracks] = ()  # of each frame, where points were followed


class ImageLoss(nn.Module):
    """The mean loss over views, with the parameters that are trained beside the teacher's own."""

    def __init__(
        self,
        teacher: TeacherModel,
        material: Material,
        settings: TeacherSettings,
        *,
        refinement: PoseRefinement | None = None,
    ) -> None:
        super().__init__()
        self.teacher = teacher
        self.correction = ColourCorrection(material.views.cameras)
        self.colour_correction = settings.colour_correction  # False: it stays zero
        self.looks = nn.Parameter(torch.zeros(material.views.frames, settings.code))
        self.refinement = refinement
        self._material, self._weights, self._rasteriser = material, settings.weights, settings.rasteriser
        self._size = figure_scale(teacher.rig.mesh.vertices)

    def forward(
        self,
        rows: Tensor,  # [B] of views
        backgrounds: Tensor,  # [B, 3] sRGB, where a camera has no image of the empty set
        moving: bool = True,  # False: the mean texture alone
    ) -> Tensor:
        """The mean loss over the views."""
        views: dict[int, list[tuple[int, Tensor]]] = {}  # cameras of each frame, and what is behind the person
        for row, colour in zip(rows.tolist(), backgrounds, strict=True):
            frame, camera = divmod(row, self._material.views.cameras)
            views.setdefault(frame, []).append((camera, colour))
        losses = [self._frame_loss(frame, of, moving=moving) for frame, of in views.items()]
        return torch.stack(losses).sum() / len(rows)

    def window(self, frame: int) -> Window:
        """The window of a frame, with refined poses where poses are refined.

        Descriptors stay those of the given poses, on which the template was trained.
        """
        window = self._material.windows[frame].to(self.looks.device)
        if self.refinement is None:
            return window
        joints = self.refinement(frame)
        newest = joints[0]
        return Window(joints, window.descriptors, self.refinement.place(newest), self.refinement.back(newest))

    @torch.no_grad()
    def keep_mean_look(self) -> None:
        """Give the teacher the mean of the frames' looks, which it shows in any motion."""
        self.teacher.look.copy_(self.looks.mean(dim=0))

    def _frame_loss(self, index: int, views: Sequence[tuple[int, Tensor]], *, moving: bool) -> Tensor:
        """The sum of the losses of a frame's views, which are drawn in one call."""
        window = self.window(index)
        frame = self.teacher(window, look=self.looks[index], moving=moving)
        splats = self.teacher.splats(frame, window.joints[0])
        seen = [(self._material.views.see(index, camera), camera, colour) for camera, colour in views]
        seen = [of for of in seen if of[0].weight > 0]  # where nobody is, nothing is drawn
        loss = len(views) * (self._regularisation(frame, index) + self._misalignment(frame, splats, index))
        if not seen:
            return loss + 0 * frame.texture.sum()  # that has a gradient in every stage
        pictures = draw_views(splats, [one.eye for one, _, _ in seen], by=self._rasteriser)
        for (one, camera, colour), drawn in zip(seen, pictures, strict=True):
            image = self.correction(drawn, camera)
            background = colour if one.background is None else one.background
            shown = image[..., :3] + (1 - image[..., 3:]) * background
            loss = loss + one.weight * self._difference(shown, image[..., 3], one, background)
        return loss

    def _difference(self, shown: Tensor, alpha: Tensor, seen: Seen, background: Tensor) -> Tensor:
        weights, truth = self._weights, seen.over(background)
        loss = weights.l1 * (shown - truth).abs().mean()
        loss = loss + weights.ssim * (1 - structural_similarity(shown, truth))
        loss = loss + weights.alpha * (alpha - seen.mask).abs().mean()
        if self._material.perceptual is not None:
            pair = (picture.permute(2, 0, 1)[None].clamp(0, 1) for picture in (shown, truth))
            loss = loss + weights.perceptual * self._material.perceptual(*pair)
        return loss

    def _misalignment(self, frame: Frame, splats: TorchSplats, index: int) -> Tensor:
        """How far texels are from where their points were followed to (the paper's L_cor-tex)."""
        if not self._material.tracks:
            return splats.centres.new_zeros(())
        offsets = frame.texture[:, ATTRIBUTES["offset"]]
        error = self._material.tracks[index].error(frame.posed, splats, offsets, size=self._size)
        return self._weights.tracks / (UNIT * self._size) ** 2 * error

    def _regularisation(self, frame: Frame, index: int) -> Tensor:
        """Regularisation: keeps near zero what the images do not determine."""
        loss = self._weights.residual * frame.added[:, GEOMETRY].square().mean()
        teacher, colours = self.teacher, slice(CONSTANT.start, None)
        painted = frame.texture[:, colours] - teacher.surfels[:, colours]
        loss = loss + self._weights.smooth * teacher.nets.surface.roughness(painted)
        loss = loss + self._weights.beside * self.looks[index].square().sum()
        if self.refinement is not None:
            loss = loss + self._weights.refinement * self.refinement.size()
        return loss + self._weights.correction * self.correction.variance()
