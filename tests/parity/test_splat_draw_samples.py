"""What a fragment draws whose middle lies outside its quad.

With several samples a pixel, a quad is drawn into pixels of which it covers a sample but not the middle: there the
offsets in its window lie beyond the ends.
"""

from pathlib import Path

import numpy as np
import wgpu

from mua.gpu import Device
from mua.player.draw import IMAGE_FORMAT, read_image

SIDE = 24  # pixels
FARTHEST = 2.5  # offset at the image's edges; 1 is a quad's
COLOR = (0.9, 0.5, 0.1, 0.8)
SHADER = """
#include "splat_draw.hlsl"

cbuffer Constants { float4 shade; float farthest; };

SplatVaryings OffsetVert(uint vertex : SV_VertexID)
{
    float2 at = float2(vertex == 1 ? 3 : -1, vertex == 2 ? 3 : -1);
    SplatVaryings varyings;
    varyings.position = float4(at, 0, 1);
    varyings.offset = at * farthest;
    varyings.color = shade;
    return varyings;
}

float4 OffsetFrag(SplatVaryings varyings) : SV_Target
{
    return splatFragment(varyings);
}
"""


def test_a_splat_adds_nothing_outside_its_quad(device: Device, tmp_path: Path) -> None:
    path = tmp_path / "offsets.hlsl"
    path.write_text(SHADER)
    pipeline = device.pipeline(
        path, "OffsetVert", "OffsetFrag", color_format=IMAGE_FORMAT, depth_format=None, blend=False
    )
    usage = wgpu.TextureUsage.RENDER_ATTACHMENT | wgpu.TextureUsage.COPY_SRC
    target = device.wgpu.create_texture(size=(SIDE, SIDE, 1), format=IMAGE_FORMAT, usage=usage)
    encoder = device.wgpu.create_command_encoder()
    cleared = {"view": target.create_view(), "load_op": "clear", "store_op": "store", "clear_value": (0, 0, 0, 0)}
    render_pass = encoder.begin_render_pass(color_attachments=[cleared])
    pipeline.bind(render_pass, {}, shade=np.array(COLOR), farthest=FARTHEST)
    render_pass.draw(3)
    render_pass.end()
    device.wgpu.queue.submit([encoder.finish()])
    image = read_image(device, target)
    offset = FARTHEST * ((np.arange(SIDE) + 0.5) / SIDE * 2 - 1)
    window = np.maximum(1 - offset**2, 0)
    alpha = COLOR[3] * np.outer(window, window)
    expected = np.stack([*(channel * alpha for channel in COLOR[:3]), alpha], axis=-1)
    outside = np.abs(offset) > 1
    assert not image[np.ix_(outside, outside)].any()
    np.testing.assert_allclose(image, expected, rtol=0, atol=1e-3)  # half floats up to 0.9
