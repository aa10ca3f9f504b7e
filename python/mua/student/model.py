"""The student in torch: a coarse mesh and two branches of wavelet blendshapes, one MLP each (paper, Methodology)."""

from itertools import pairwise
from typing import NamedTuple

import torch
from torch import Tensor, nn

from mua.channels import APPEARANCE, CHANNELS, COARSE_TEXELS, GEOMETRY, STATIC_LEVELS
from mua.pose.encoding import Components as StoredComponents
from mua.pose.encoding import PoseEncoding
from mua.student.components import Components
from mua.student.settings import Ranks, Settings
from mua.wavelets import Bands, synthesise_lowpass, waverec2

HIDDEN_LAYERS = 2


class Alphas(NamedTuple):
    """Blendshape coefficients alpha(r, c) of F frames, per channel as the paper writes them."""

    ll: Tensor  # [F, C, R_LL]
    d3: Tensor  # [F, C, R_3]
    d2: Tensor  # [F, C, R_2]

    def flat(self) -> Tensor:
        """[F, M], the order in which a coefficient MLP puts them out."""
        return torch.cat([level.flatten(1) for level in self], dim=1)


def build_mlp(inputs: int, hidden: int, outputs: int) -> nn.Sequential:
    """A shallow MLP: ReLU after every layer but the last."""
    widths = [inputs, *[hidden] * HIDDEN_LAYERS]
    layers: list[nn.Module] = []
    for fan_in, fan_out in pairwise(widths):
        layers += [nn.Linear(fan_in, fan_out), nn.ReLU()]
    return nn.Sequential(*layers, nn.Linear(hidden, outputs))


def linear_layers(mlp: nn.Module) -> list[nn.Linear]:
    return [layer for layer in mlp.modules() if isinstance(layer, nn.Linear)]


def outer_products(
    h: Tensor,  # [3, C, R, n]
    w: Tensor,  # [3, C, R, n]
) -> Tensor:
    """The blendshapes [C, R, 3 n n] that factors stand for: h (x) w of the three bands, flattened."""
    return torch.einsum("scri,scrj->crsij", h, w).flatten(2)


class Detail(nn.Module):
    """The three detail subbands of one level: mean + sum_r alpha(r, c) h (x) w, with alpha shared by the bands."""

    mean: Tensor

    def __init__(self, channels: int, rank: int, size: int) -> None:
        super().__init__()
        self.register_buffer("mean", torch.zeros(3, channels, size, size))
        self.h = nn.Parameter(torch.zeros(3, channels, rank, size))
        self.w = nn.Parameter(torch.zeros(3, channels, rank, size))

    def forward(self, alpha: Tensor) -> Tensor:
        """Subbands [F, 3, C, n, n] of coefficients [F, C, R]."""
        by_frame = alpha.transpose(0, 1)[:, :, None]  # [C, F, 1, R]
        rows = by_frame * self.h.mT.contiguous()[:, :, None]  # [3, C, F, n, R]
        bands = rows.flatten(2, 3) @ self.w  # all frames in one product, which is faster than one for each
        return bands.unflatten(2, rows.shape[2:4]).permute(2, 0, 1, 3, 4) + self.mean


class Branch(nn.Module):
    """Geometry or appearance: F_coeff and the subbands that its coefficients drive."""

    ll_mean: Tensor
    mlp: nn.Module  # a plain MLP except while it is fitted

    def __init__(self, channels: int, ranks: Ranks, size: int, *, inputs: int, hidden: int) -> None:
        super().__init__()
        self.channels = channels
        self.ranks = ranks
        self.mlp = build_mlp(inputs, hidden, channels * ranks.total)
        self.register_buffer("ll_mean", torch.zeros(channels, size, size))
        self.ll_basis = nn.Parameter(torch.zeros(channels, ranks.ll, size, size))
        self.d3 = Detail(channels, ranks.d3, size)
        self.d2 = Detail(channels, ranks.d2, 2 * size)

    def split(self, flat: Tensor) -> Alphas:
        """Name the parts of an MLP output [F, M]."""
        sizes = (self.ranks.ll, self.ranks.d3, self.ranks.d2)
        parts = flat.split([self.channels * rank for rank in sizes], dim=1)
        return Alphas(*(part.unflatten(1, (self.channels, rank)) for part, rank in zip(parts, sizes, strict=True)))

    @torch.no_grad()
    def silence(self, channels: Tensor) -> None:
        """Zero the blendshapes of some channels [C], bool: they get no gradient and stay at their mean."""
        self.ll_basis[channels] = 0
        for detail in (self.d3, self.d2):
            detail.h[:, channels] = 0
            detail.w[:, channels] = 0

    def synthesize(self, alphas: Alphas) -> Bands:
        """The subbands of given coefficients."""
        ll = torch.bmm(alphas.ll.transpose(0, 1), self.ll_basis.flatten(2))  # [C, F, n n]
        ll = ll.transpose(0, 1).unflatten(2, self.ll_mean.shape[1:]) + self.ll_mean
        return Bands(ll, self.d3(alphas.d3), self.d2(alphas.d2))

    def channel(self, channel: int) -> tuple[Tensor, ...]:
        """Views of the means and bases of one channel."""
        own = [self.ll_mean[channel], self.ll_basis[channel]]
        for detail in (self.d3, self.d2):
            own += [detail.mean[:, channel], detail.h[:, channel], detail.w[:, channel]]
        return tuple(own)

    def forward(self, inputs: Tensor) -> Bands:
        """The subbands of components [F, K]."""
        return self.synthesize(self.split(self.mlp(inputs)))


class Coarse(nn.Module):
    """F_temp and the PCA of the canonical mesh (paper, Animatable Coarse Geometry)."""

    mean: Tensor
    basis: Tensor

    def __init__(self, vertices: int, components: int, *, inputs: int, hidden: int) -> None:
        super().__init__()
        self.mlp = build_mlp(inputs, hidden, components)
        self.register_buffer("mean", torch.zeros(vertices, 3))
        self.register_buffer("basis", torch.zeros(components, vertices, 3))

    def forward(self, inputs: Tensor) -> Tensor:
        """Canonical vertices [F, V, 3], metres, of components [F, K]."""
        return torch.einsum("fk,kvx->fvx", self.mlp(inputs), self.basis) + self.mean


class Student(nn.Module):
    """The whole student; descriptors enter as `mua.pose.descriptor` makes them, and the MLPs read their components."""

    mean: Tensor
    scale: Tensor
    directions: Tensor
    ranges: Tensor
    margins: Tensor
    static: Tensor
    texels: Tensor

    def __init__(
        self,
        settings: Settings,
        *,
        encoding: PoseEncoding,
        inputs: int,  # components of the descriptor that the MLPs read
        vertices: int,
        texels: Tensor,  # [N] the valid texels as row * size + col
        wavelet: str,
    ) -> None:
        super().__init__()
        self.size = settings.texels
        self.encoding = encoding
        self.wavelet = wavelet
        width, coarsest = settings.hidden, settings.texels // COARSE_TEXELS
        self.register_buffer("mean", torch.zeros(encoding.width))
        self.register_buffer("scale", torch.ones(encoding.width))
        self.register_buffer("directions", torch.zeros(inputs, encoding.width))
        self.register_buffer("ranges", torch.zeros(2, inputs))
        self.register_buffer("margins", torch.zeros(inputs))
        self.register_buffer("texels", texels.long())
        self.register_buffer("static", torch.zeros(CHANNELS, len(texels)))
        self.coarse = Coarse(vertices, settings.components, inputs=inputs, hidden=width)
        self.geometry = Branch(_count(GEOMETRY), settings.geometry, coarsest, inputs=inputs, hidden=width)
        self.appearance = Branch(_count(APPEARANCE), settings.appearance, coarsest, inputs=inputs, hidden=width)

    @property
    def branches(self) -> tuple[Branch, Branch]:
        return self.geometry, self.appearance

    @property
    def components(self) -> Components:
        """The components of normalised descriptors."""
        return Components(self.directions, self.ranges, self.margins)

    def set_components(self, components: StoredComponents) -> None:
        """Set normalisation and components from those of the training descriptors."""
        normalization = components.normalization
        self.mean.copy_(torch.from_numpy(normalization.mean))
        self.scale.copy_(torch.from_numpy(normalization.scale))
        self.directions.copy_(torch.from_numpy(components.directions))
        self.ranges.copy_(torch.from_numpy(components.ranges))
        self.margins.copy_(torch.from_numpy(components.margins))

    def read_buffers(self) -> dict[str, Tensor]:
        """The buffers that map a descriptor to the MLPs' input."""
        return {name: getattr(self, name) for name in ("mean", "scale", "directions", "ranges", "margins")}

    def normalize(self, descriptors: Tensor) -> Tensor:
        return (descriptors - self.mean) / self.scale

    def read(self, descriptors: Tensor) -> Tensor:
        """The MLPs' inputs [F, K] for descriptors [F, D]."""
        return self.components.hold(self.components(self.normalize(descriptors)))

    def mesh(self, descriptors: Tensor) -> Tensor:
        """Canonical vertices [F, V, 3], metres."""
        return self.coarse(self.read(descriptors))

    def coefficients(self, descriptors: Tensor) -> tuple[Alphas, Alphas]:
        """The coefficients that the MLPs predict, geometry and appearance."""
        inputs = self.read(descriptors)
        return self.geometry.split(self.geometry.mlp(inputs)), self.appearance.split(self.appearance.mlp(inputs))

    def synthesize(self, alphas: tuple[Alphas, Alphas]) -> Bands:
        """Subbands of all 23 channels."""
        geometry, appearance = (branch.synthesize(part) for branch, part in zip(self.branches, alphas, strict=True))
        return Bands(
            torch.cat([geometry.ll, appearance.ll], dim=1),
            torch.cat([geometry.d3, appearance.d3], dim=2),
            torch.cat([geometry.d2, appearance.d2], dim=2),
        )

    def predict(self, descriptors: Tensor) -> Bands:
        """Subbands of all 23 channels of descriptors [F, D]."""
        return self.synthesize(self.coefficients(descriptors))

    def texture(self, bands: Bands) -> Tensor:
        """The full texture [F, N, 23] at the valid texels: IDWT of the dynamic subbands plus the static offset."""
        return (lowpass_texels(bands, self.wavelet, self.texels) + self.static).transpose(1, 2)

    def mean_lowpass(self) -> Tensor:
        """The contribution of the dynamic subbands' mean to the valid texels [23, N]."""
        geometry, appearance = self.branches
        ll = torch.cat([geometry.ll_mean, appearance.ll_mean])
        d3 = torch.cat([geometry.d3.mean, appearance.d3.mean], dim=1)
        d2 = torch.cat([geometry.d2.mean, appearance.d2.mean], dim=1)
        return lowpass_texels(Bands(ll[None], d3[None], d2[None]), self.wavelet, self.texels)[0]


def lowpass_texels(bands: Bands, wavelet: str, texels: Tensor) -> Tensor:
    """IDWT(LL, D3, D2, 0, 0) [F, C, N] at the valid texels [N]."""
    quarter = waverec2(bands.ll, [bands.d3.transpose(1, 2), bands.d2.transpose(1, 2)], wavelet)
    return synthesise_lowpass(quarter, wavelet, STATIC_LEVELS).flatten(2)[..., texels]


def _count(channels: slice) -> int:
    return channels.stop - channels.start
