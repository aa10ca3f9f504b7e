"""A glTF binary under construction: arrays become accessors, all of them in one buffer."""

import numpy as np
import pygltflib
from pygltflib import GLTF2, Accessor, Asset, Buffer, BufferView, Node, Scene

from mua.arrays import Array
from mua.version import __version__

COMPONENTS = {"|u1": 5121, "<u2": 5123, "<u4": 5125, "<f4": 5126}
SHAPES = {(): "SCALAR", (2,): "VEC2", (3,): "VEC3", (4,): "VEC4", (4, 4): "MAT4"}
VERTICES, INDICES = pygltflib.ARRAY_BUFFER, pygltflib.ELEMENT_ARRAY_BUFFER
UNLIT = "KHR_materials_unlit"


class Glb:
    """The document, and the bytes of its buffer so far."""

    def __init__(self) -> None:
        self.document = GLTF2(
            asset=Asset(generator=f"mua-export {__version__}", version="2.0"),
            scene=0,
            scenes=[Scene(nodes=[])],
        )
        self._buffer = bytearray()

    def accessor(
        self,
        values: Array,  # [count, ...] of one of COMPONENTS and SHAPES; matrices row by row
        *,
        target: int | None = None,
        normalized: bool = False,
        bounds: bool = False,
    ) -> int:
        """Add an accessor and return its index."""
        if values.ndim == 3:
            values = values.swapaxes(1, 2)  # glTF has them column by column
        found = Accessor(
            bufferView=self.view(np.ascontiguousarray(values).tobytes(), target=target),
            componentType=COMPONENTS[values.dtype.str],
            count=len(values),
            type=SHAPES[values.shape[1:]],
            normalized=normalized,
            min=np.atleast_1d(values.min(axis=0)).tolist() if bounds else None,
            max=np.atleast_1d(values.max(axis=0)).tolist() if bounds else None,
        )
        self.document.accessors.append(found)
        return len(self.document.accessors) - 1

    def view(self, content: bytes, *, target: int | None = None) -> int:
        """Add a part of the buffer and return its index."""
        self._buffer += bytes(-len(self._buffer) % 4)
        view = BufferView(buffer=0, byteOffset=len(self._buffer), byteLength=len(content), target=target)
        self._buffer += content
        self.document.bufferViews.append(view)
        return len(self.document.bufferViews) - 1

    def node(self, node: Node, *, in_scene: bool = True) -> int:
        """Add a node and return its index."""
        self.document.nodes.append(node)
        number = len(self.document.nodes) - 1
        if in_scene:
            self.document.scenes[0].nodes.append(number)
        return number

    def use(self, extension: str) -> None:
        """Declare an extension as used; readers that do not know it may still open the file."""
        if extension not in self.document.extensionsUsed:
            self.document.extensionsUsed.append(extension)

    def content(self) -> bytes:
        """The bytes of the file."""
        self.document.buffers = [Buffer(byteLength=len(self._buffer))]
        self.document.set_binary_blob(bytes(self._buffer))
        return b"".join(self.document.save_to_bytes())


def xyzw(
    rotations: Array,  # [..., 4] wxyz
) -> Array:
    """Quaternions [..., 4] float32 in the order of glTF."""
    return np.roll(rotations, -1, axis=-1).astype("<f4")


def to_linear(
    srgb: Array,  # in 0..1
) -> Array:
    """Linear values of sRGB ones (IEC 61966-2-1)."""
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
