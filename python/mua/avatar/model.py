"""What decoding an avatar needs: its rig, its descriptor, its MLPs and the subbands they drive, as numpy arrays.

Spatial tensors are channel-first: a GPU reads them plane by plane.
"""

from dataclasses import dataclass

from mua.arrays import Array
from mua.pose.encoding import Components, PoseEncoding
from mua.rig.rig import Rig


@dataclass(frozen=True, eq=False)
class Layer:
    """y = act(W x + b); ReLU on every layer but the last of its MLP."""

    weight: Array  # [out, in]
    bias: Array  # [out]


Mlp = tuple[Layer, ...]


@dataclass(frozen=True, eq=False)
class DetailBand:
    """The three detail subbands of one level: mean + sum_r alpha(r, c) h (x) w (paper, Dynamic mid-frequency subbands).

    Subbands are in the order of pywt's (cH, cV, cD): high-pass along rows' axis 0, along axis 1, along both.
    """

    mean: Array  # [3, C, n, n]
    h: Array  # [3, C, R, n] along axis 0 (rows)
    w: Array  # [3, C, R, n] along axis 1 (columns)


@dataclass(frozen=True, eq=False)
class Branch:
    """Geometry (C = 11) or appearance (C = 12): one coefficient MLP and the subbands that its output drives.

    The MLP's output is the concatenation of alpha_LL [C, R_LL], alpha_D3 [C, R_3], alpha_D2 [C, R_2], each row-major.
    """

    mlp: Mlp
    ll_mean: Array  # [C, n, n]
    ll_basis: Array  # [C, R, n, n]
    details: tuple[DetailBand, ...]  # coarse first: D3, D2
    static: Array  # [C, N] static IDWT offset at the valid texels: IDWT(0, 0, 0, mean D1, mean D0)

    @property
    def channels(self) -> int:
        return int(self.ll_mean.shape[0])

    @property
    def ranks(self) -> tuple[int, ...]:
        """Ranks of LL, D3, D2."""
        return (int(self.ll_basis.shape[1]), *(int(band.h.shape[2]) for band in self.details))


@dataclass(frozen=True, eq=False)
class Coarse:
    """The coarse mesh: F_temp predicts the PCA coefficients of the canonical vertices (paper, Coarse Geometry)."""

    mlp: Mlp
    mean: Array  # [V, 3] metres
    basis: Array  # [K, V, 3]


@dataclass(frozen=True, eq=False)
class Wavelet:
    """Synthesis filters of a wavelet in periodization mode; LL size x 2^(levels - coarser) texels."""

    name: str  # spline3, or as in PyWavelets, e.g. bior4.4
    levels: int  # 4
    rec_lo: Array  # [L] float64
    rec_hi: Array  # [L] float64
    coarser: int = 0  # how often blocks of 2 x 2 texels were merged (mua.avatar.coarser)


@dataclass(frozen=True, eq=False)
class Model:
    """Everything that turns a window of poses into splats."""

    rig: Rig
    encoding: PoseEncoding
    components: Components
    coarse: Coarse
    geometry: Branch
    appearance: Branch
    wavelet: Wavelet
    bounds: Array  # [2, 3] lowest and highest corner of all playback poses about the root joint's position, metres
