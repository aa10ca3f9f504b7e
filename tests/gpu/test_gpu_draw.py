"""Images of single triangles, in values that a half float holds exactly."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import wgpu

from mua.arrays import Array
from mua.errors import InputError
from mua.gpu import Device
from mua.gpu.draw import Pipeline

SIDE = 8
SHADER = """
StructuredBuffer<float2> corners;
StructuredBuffer<float4> tints;
cbuffer Constants { float depth; float scale; };
struct Varyings { float4 position : SV_Position; nointerpolation uint tint : TEXCOORD0; };
Varyings TriangleVert(uint vertex : SV_VertexID)
{
    Varyings v;
    v.position = float4(corners[vertex], depth, 1);
    v.tint = vertex / 3;
    return v;
}
float4 TriangleFrag(Varyings v) : SV_Target { return tints[v.tint] * scale; }
"""
UPPER_HALF = np.array([[-1, 0], [3, 0], [-1, 4]], np.float32)  # clip space: the rows above the middle
ALL = np.array([[-1, -1], [3, -1], [-1, 3]], np.float32)
CLEAR = [0.5, 0.25, 0.125, 1]


def pipeline(device: Device, directory: Path, **options: Any) -> Pipeline:
    path = directory / "triangle.hlsl"
    path.write_text(SHADER)
    state: dict[str, Any] = {"color_format": "rgba16float", "depth_format": None, "blend": False}
    return device.pipeline(path, "TriangleVert", "TriangleFrag", **(state | options))


def drawn(device: Device, drawing: Pipeline, calls: list[tuple[Array, list[float], float]], depth: bool) -> Array:
    """The image [SIDE, SIDE, 4] of triangles, each with its tint and depth, over CLEAR."""
    usage = wgpu.TextureUsage.RENDER_ATTACHMENT | wgpu.TextureUsage.COPY_SRC
    color = device.wgpu.create_texture(size=(SIDE, SIDE, 1), format="rgba16float", usage=usage)
    attachment = {"view": color.create_view(), "load_op": "clear", "store_op": "store", "clear_value": CLEAR}
    nearest = None
    if depth:
        texture = device.wgpu.create_texture(
            size=(SIDE, SIDE, 1), format="depth32float", usage=wgpu.TextureUsage.RENDER_ATTACHMENT
        )
        view = texture.create_view()
        nearest = {"view": view, "depth_load_op": "clear", "depth_store_op": "store", "depth_clear_value": 1.0}
    encoder = device.wgpu.create_command_encoder()
    render_pass = encoder.begin_render_pass(color_attachments=[attachment], depth_stencil_attachment=nearest)
    for corners, tint, z in calls:
        tints = device.buffer(np.array([tint], np.float32), name="tints")
        drawing.bind(
            render_pass, {"corners": device.buffer(corners, name="corners"), "tints": tints}, depth=z, scale=0.5
        )
        render_pass.draw(3)
    render_pass.end()
    device.wgpu.queue.submit([encoder.finish()])
    layout = {"bytes_per_row": 8 * SIDE, "rows_per_image": SIDE}
    read = device.wgpu.queue.read_texture({"texture": color}, layout, (SIDE, SIDE, 1))
    return np.frombuffer(read, np.float16).reshape(SIDE, SIDE, 4)


def test_y_points_up_and_both_stages_get_their_names(device: Device, tmp_path: Path) -> None:
    image = drawn(device, pipeline(device, tmp_path), [(UPPER_HALF, [1, 2, 3, 4], 0.0)], depth=False)
    assert np.all(image[: SIDE // 2] == [0.5, 1, 1.5, 2])
    assert np.all(image[SIDE // 2 :] == CLEAR)


def test_blending_lays_premultiplied_colour_over(device: Device, tmp_path: Path) -> None:
    image = drawn(device, pipeline(device, tmp_path, blend=True), [(ALL, [0.5, 0, 0, 0.5], 0.0)], depth=False)
    assert np.all(image == np.array([0.25, 0, 0, 0.25]) + 0.75 * np.array(CLEAR))


@pytest.mark.parametrize("write", [False, True])
def test_nearer_triangles_hide_farther_ones(device: Device, tmp_path: Path, write: bool) -> None:
    drawing = pipeline(device, tmp_path, depth_format="depth32float", depth_write=write, depth_compare="less-equal")
    image = drawn(device, drawing, [(ALL, [2, 0, 0, 2], 0.25), (UPPER_HALF, [0, 2, 0, 2], 0.75)], depth=True)
    upper = [1, 0, 0, 1] if write else [0, 1, 0, 1]
    assert np.all(image[: SIDE // 2] == upper)
    assert np.all(image[SIDE // 2 :] == [1, 0, 0, 1])


def test_culled_triangles_are_not_drawn(device: Device, tmp_path: Path) -> None:
    for cull, seen in (("back", True), ("front", False)):  # ALL runs counter-clockwise
        image = drawn(device, pipeline(device, tmp_path, cull=cull), [(ALL, [2, 2, 2, 2], 0.0)], depth=False)
        assert np.all(image == (1 if seen else np.array(CLEAR)))


def test_rejects_wrong_names(device: Device, tmp_path: Path) -> None:
    drawing = pipeline(device, tmp_path)
    corners, tints = device.buffer(ALL, name="corners"), device.buffer(16, name="tints")
    label = "pipeline TriangleVert with TriangleFrag"
    calls: list[tuple[dict[str, Any], dict[str, float], str]] = [
        ({"corners": corners}, {"depth": 0, "scale": 1}, "buffer tints is missing"),
        ({"corners": corners, "tints": tints}, {"depth": 0}, "constant scale is missing"),
        ({"corners": corners, "tints": tints}, {"depth": 0, "scale": 1, "x": 1}, "has no constant x"),
    ]
    for buffers, constants, sentence in calls:
        with pytest.raises(InputError, match=f"{label}: {sentence}"):
            drawing.bind(None, buffers, **constants)


def test_rejects_a_missing_entry(device: Device, tmp_path: Path) -> None:
    path = tmp_path / "triangle.hlsl"
    path.write_text(SHADER)
    with pytest.raises(InputError, match=r"triangle\.hlsl: Nonesuch does not compile"):
        device.pipeline(path, "Nonesuch", "TriangleFrag", color_format="rgba16float", depth_format=None, blend=False)
