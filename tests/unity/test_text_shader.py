"""The sample's letters, drawn on a device: their place, their colour, and the rim that hides nothing."""

import numpy as np
import pytest
import wgpu
from shader_programs import SAMPLES, programs

from mua.arrays import Array
from mua.gpu import Device
from mua.gpu.compile import spirv
from mua.player.draw import read_image

SIDE = 8  # pixels; the font has a texel for each column
RIM = 0.1  # opacity below which nothing is drawn
COLOR = (0.2, 0.4, 0.6, 0.5)
COVER = np.array([0, 25, 50, 52, 100, 150, 200, 255], np.uint8)  # the font's coverage by column
ROUNDED = 1e-6  # single precision
ATTRIBUTES = (("float32x3", 0), ("float32x4", 12), ("float32x2", 28))  # place, color, uv: their bytes in a vertex


@pytest.fixture(scope="module")
def image(device: Device, tmp_path_factory: pytest.TempPathFactory) -> Array:
    """[SIDE, SIDE, 4] of a quad over the right half of a target that was green, its texture over the whole of it."""
    (path,) = [path for path in SAMPLES if path.stem == "text"]
    (program,) = programs(path)
    file = program.write(tmp_path_factory.mktemp("text"))
    gpu, usage = device.wgpu, wgpu.BufferUsage
    stages = [(program.vertex, "vert"), (program.fragment, "frag")]
    modules = [gpu.create_shader_module(code=spirv(file, entry, stage=stage)) for entry, stage in stages]
    buffers = {"array_stride": 36, "attributes": [_attribute(i, *each) for i, each in enumerate(ATTRIBUTES)]}
    pipeline = gpu.create_render_pipeline(
        layout="auto",
        vertex={"module": modules[0], "entry_point": program.vertex, "buffers": [buffers]},
        fragment={"module": modules[1], "entry_point": program.fragment, "targets": [{"format": "rgba32float"}]},
        primitive={"topology": "triangle-strip"},
    )
    corners = [(x, y, 0.5) for y in (-1, 1) for x in (0, 2)]
    vertices = np.array([(*at, *COLOR, at[0] / 2, (1 + at[1]) / 2) for at in corners], np.float32)
    matrix = np.diag([0.5, 1, 1, 1]).astype(np.float32)  # half as wide: the quad ends where the target does
    constants = np.zeros(36, np.float32)
    constants[:16] = matrix.ravel()
    font = gpu.create_texture(
        size=(SIDE, 1, 1), format="rgba8unorm", usage=wgpu.TextureUsage.TEXTURE_BINDING | wgpu.TextureUsage.COPY_DST
    )
    texels = np.zeros((SIDE, 4), np.uint8)
    texels[:, 3] = COVER
    gpu.queue.write_texture({"texture": font}, texels.tobytes(), {"bytes_per_row": 4 * SIDE}, (SIDE, 1, 1))
    given = [
        [{"binding": 0, "resource": {"buffer": gpu.create_buffer_with_data(data=constants, usage=usage.UNIFORM)}}],
        [{"binding": 0, "resource": font.create_view()}, {"binding": 1, "resource": gpu.create_sampler()}],
    ]
    target = gpu.create_texture(
        size=(2 * SIDE, SIDE, 1),
        format="rgba32float",
        usage=wgpu.TextureUsage.RENDER_ATTACHMENT | wgpu.TextureUsage.COPY_SRC,
    )
    encoder = gpu.create_command_encoder()
    clear = {"load_op": "clear", "store_op": "store", "clear_value": (0, 1, 0, 1)}
    drawing = encoder.begin_render_pass(color_attachments=[{"view": target.create_view(), **clear}])
    drawing.set_pipeline(pipeline)
    for group, entries in enumerate(given):
        drawing.set_bind_group(
            group, gpu.create_bind_group(layout=pipeline.get_bind_group_layout(group), entries=entries)
        )
    drawing.set_vertex_buffer(0, gpu.create_buffer_with_data(data=vertices, usage=usage.VERTEX))
    drawing.draw(4)
    drawing.end()
    gpu.queue.submit([encoder.finish()])
    return read_image(device, target)


def _attribute(location: int, kind: str, offset: int) -> dict[str, object]:
    return {"format": kind, "offset": offset, "shader_location": location}


def test_letters_have_the_colour_of_the_text_and_the_fonts_cover(image: Array) -> None:
    opacity = COLOR[3] * COVER / 255
    drawn = np.where((opacity >= RIM)[:, None], np.column_stack([np.tile(COLOR[:3], (SIDE, 1)), opacity]), [0, 1, 0, 1])
    np.testing.assert_allclose(image[:, SIDE:], np.broadcast_to(drawn, (SIDE, SIDE, 4)), atol=ROUNDED)
    assert [index for index, cover in enumerate(opacity) if cover >= RIM] == [3, 4, 5, 6, 7]


def test_nothing_is_drawn_beside_the_letters(image: Array) -> None:
    np.testing.assert_array_equal(image[:, :SIDE], np.broadcast_to([0, 1, 0, 1], (SIDE, SIDE, 4)))
