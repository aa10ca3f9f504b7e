"""Splats of one frame as glTF points by KHR_gaussian_splatting.

https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Khronos/KHR_gaussian_splatting. Readers that do not know
the extension show coloured points. It has no hint that splats are filtered over the pixel.
"""

import numpy as np
from pygltflib import Attributes, Material, Mesh, Node, Primitive

from mua.export.glb import UNLIT, VERTICES, Glb, to_linear, xyzw
from mua.export.splats import WorldSplats

EXTENSION = "KHR_gaussian_splatting"
POINTS = 0
SETTINGS = {"kernel": "ellipse", "colorSpace": "srgb_rec709_display", "projection": "perspective"}


def splat_glb(splats: WorldSplats, *, name: str) -> bytes:
    """The content of a .glb; Y should be up."""
    glb = Glb()
    glb.use(EXTENSION)
    glb.use(UNLIT)
    glb.document.materials = [Material(extensions={UNLIT: {}}, alphaMode="BLEND")]
    primitive = Primitive(
        attributes=_attributes(glb, splats), mode=POINTS, material=0, extensions={EXTENSION: SETTINGS}
    )
    glb.document.meshes = [Mesh(name=name, primitives=[primitive])]
    glb.node(Node(name=name, mesh=0))
    return glb.content()


def _attributes(glb: Glb, splats: WorldSplats) -> Attributes:
    coefficients = splats.sh.reshape(-1, 4, 3).astype("<f4")
    arrays = {
        "ROTATION": xyzw(splats.rotations),
        "SCALE": splats.scales.astype("<f4"),
        "OPACITY": splats.opacities.astype("<f4"),
        "SH_DEGREE_0_COEF_0": coefficients[:, 0],
        **{f"SH_DEGREE_1_COEF_{k}": coefficients[:, 1 + k] for k in range(3)},
    }
    linear = to_linear(np.clip(splats.mean_colors, 0, 1))
    color = np.rint(np.column_stack([linear, splats.opacities]) * 65535).astype("<u2")
    attributes = Attributes(
        POSITION=glb.accessor(splats.centres.astype("<f4"), target=VERTICES, bounds=True),
        COLOR_0=glb.accessor(color, target=VERTICES, normalized=True),
    )
    for key, values in arrays.items():
        setattr(attributes, f"{EXTENSION}:{key}", glb.accessor(values, target=VERTICES))
    return attributes
