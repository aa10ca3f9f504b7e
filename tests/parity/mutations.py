"""One-line faults of the shaders, each of which the kernel's parity test must notice (test_mutations.py).

Not listed, because no image and no number shows them: reads past a tile's edge whose results are not written.
"""

from decode_faults import DECODING
from splat_faults import SPLATS

FAULTS = DECODING | SPLATS
