"""The 23 channels of a Gaussian texture, before activation (paper, Sec. Teacher Model): geometry 11, appearance 12.

Offsets are metres in canonical space; quaternions wxyz raw; scales are natural logarithms of metres;
opacity is a logit; SH is degree 1, coefficient-major (coefficient, rgb), in canonical space:
colour = 0.5 + C0 c0 + C1 (-y c1 + z c2 - x c3) for the unit direction (x, y, z) from camera to splat.
"""

from mua.limits import MAX_DETAIL_LEVELS, MOST_TAPS

GEOMETRY = slice(0, 11)
APPEARANCE = slice(11, 23)
CHANNELS = 23

ATTRIBUTES = {
    "offset": slice(0, 3),
    "rotation": slice(3, 7),
    "scale": slice(7, 10),
    "opacity": slice(10, 11),
    "SH": slice(11, 23),
}

SH_C0 = 0.28209479177387814  # 1 / (2 sqrt(pi))
SH_C1 = 0.4886025119029199  # sqrt(3 / (4 pi))

# Wavelet levels of a texture: coarse ones vary with the frame, fine ones are means (paper, Methodology).
DYNAMIC_LEVELS, STATIC_LEVELS = 2, 2  # D3 and D2; D1 and D0
LEVELS = DYNAMIC_LEVELS + STATIC_LEVELS

# Texels along a side of a sample of LL and D3, of D2, and of the low-pass image that LL, D3 and D2 make together.
COARSE_TEXELS = 1 << LEVELS
FINE_TEXELS = 1 << (LEVELS - 1)
LOWPASS_TEXELS = 1 << STATIC_LEVELS


def most_levels(levels: int, details: int, *, taps: int) -> int:
    """How many levels of detail a texture may have beyond its texels.

    Details that vary with the frame would have to be computed to be averaged: their levels are never left out.
    """
    return min(MAX_DETAIL_LEVELS, levels - details) if taps <= MOST_TAPS else 0
