"""The wavelet levels of a texture: coarse ones vary with the frame, fine ones are means (paper, Methodology)."""

DYNAMIC_LEVELS, STATIC_LEVELS = 2, 2  # D3 and D2; D1 and D0
LEVELS = DYNAMIC_LEVELS + STATIC_LEVELS

# Texels along a side of a sample of LL and D3, of D2, and of the low-pass image that LL, D3 and D2 make together.
COARSE_TEXELS = 1 << LEVELS
FINE_TEXELS = 1 << (LEVELS - 1)
LOWPASS_TEXELS = 1 << STATIC_LEVELS
