// Generated from python/mua/player/shaders/skeleton.hlsl by tools/gen_wgsl.py; do not edit.

/** @type {import("../shader.js").Shader} */
export const StrokeVert = {
  ...{"stage": "vert", "entry": "StrokeVert", "buffers": [{"name": "joints", "binding": 0, "read_only": true, "scalar": "float", "stride": 16}, {"name": "strokes", "binding": 1, "read_only": true, "scalar": "uint", "stride": 8}], "constants": [{"name": "view_projection", "offset": 0, "scalar": "float", "shape": [4, 4], "strides": [4, 16], "used": true}, {"name": "color", "offset": 64, "scalar": "float", "shape": [4], "strides": [4], "used": false}, {"name": "screen", "offset": 80, "scalar": "float", "shape": [2], "strides": [4], "used": true}, {"name": "width", "offset": 88, "scalar": "float", "shape": [], "strides": [], "used": true}], "constants_binding": 2, "threads": [1, 1, 1]},
  code: `@binding(1) @group(0) var<storage, read> strokes_0 : array<vec2<u32>>;

@binding(0) @group(0) var<storage, read> joints_0 : array<vec4<f32>>;

struct _MatrixStorage_float4x4_ColMajorstd140_0
{
    @align(16) data_0 : array<vec4<f32>, i32(4)>,
};

struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) view_projection_0 : _MatrixStorage_float4x4_ColMajorstd140_0,
    @align(16) color_0 : vec4<f32>,
    @align(16) screen_0 : vec2<f32>,
    @align(8) width_0 : f32,
};

@binding(2) @group(0) var<uniform> Constants_0 : SLANG_ParameterGroup_Constants_std140_0;
fn strokeEnd_0( end_0 : vec4<f32>,  other_0 : vec4<f32>) -> vec4<f32>
{
    var _S1 : f32 = end_0.w;
    var share_0 : f32 = saturate((0.00100000004749745f - _S1) / max(other_0.w - _S1, 9.99999968265522539e-21f));
    var _S2 : vec4<f32>;
    if(_S1 < 0.00100000004749745f)
    {
        _S2 = mix(end_0, other_0, vec4<f32>(share_0));
    }
    else
    {
        _S2 = end_0;
    }
    return _S2;
}

struct StrokeVaryings_0
{
    @builtin(position) position_0 : vec4<f32>,
    @interpolate(linear) @location(0) offset_0 : vec2<f32>,
    @interpolate(flat) @location(1) extent_0 : vec2<f32>,
};

fn strokeVertex_0( corner_0 : u32,  start_0 : vec3<f32>,  end_1 : vec3<f32>,  width_1 : f32,  screen_1 : vec2<f32>,  viewProjection_0 : mat4x4<f32>) -> StrokeVaryings_0
{
    var first_0 : vec4<f32> = (((vec4<f32>(start_0, 1.0f)) * (viewProjection_0)));
    var last_0 : vec4<f32> = (((vec4<f32>(end_1, 1.0f)) * (viewProjection_0)));
    var hidden_0 : bool = (max(first_0.w, last_0.w)) < 0.00100000004749745f;
    var clippedFirst_0 : vec4<f32> = strokeEnd_0(first_0, last_0);
    var clippedLast_0 : vec4<f32> = strokeEnd_0(last_0, first_0);
    var _S3 : vec2<f32> = vec2<f32>(2.0f);
    var from_0 : vec2<f32> = clippedFirst_0.xy / vec2<f32>(max(clippedFirst_0.w, 0.00100000004749745f)) * screen_1 / _S3;
    var to_0 : vec2<f32> = clippedLast_0.xy / vec2<f32>(max(clippedLast_0.w, 0.00100000004749745f)) * screen_1 / _S3;
    var reach_0 : f32 = distance(from_0, to_0);
    var along_0 : vec2<f32>;
    if(reach_0 > 0.0f)
    {
        along_0 = (to_0 - from_0) / vec2<f32>(reach_0);
    }
    else
    {
        along_0 = vec2<f32>(1.0f, 0.0f);
    }
    var varyings_0 : StrokeVaryings_0;
    varyings_0.extent_0 = vec2<f32>(reach_0 / 2.0f, width_1 / 2.0f);
    var right_0 : bool;
    if(corner_0 == u32(1))
    {
        right_0 = true;
    }
    else
    {
        right_0 = corner_0 == u32(2);
    }
    if(right_0)
    {
        right_0 = true;
    }
    else
    {
        right_0 = corner_0 == u32(4);
    }
    var below_0 : bool;
    if(corner_0 == u32(2))
    {
        below_0 = true;
    }
    else
    {
        below_0 = corner_0 == u32(4);
    }
    if(below_0)
    {
        below_0 = true;
    }
    else
    {
        below_0 = corner_0 == u32(5);
    }
    var _S4 : i32;
    if(right_0)
    {
        _S4 = i32(1);
    }
    else
    {
        _S4 = i32(-1);
    }
    var _S5 : f32 = f32(_S4);
    if(below_0)
    {
        _S4 = i32(1);
    }
    else
    {
        _S4 = i32(-1);
    }
    var _S6 : vec2<f32> = vec2<f32>(_S5, f32(_S4)) * (vec2<f32>(reach_0 / 2.0f, 0.0f) + vec2<f32>((width_1 / 2.0f)) + vec2<f32>(1.0f));
    varyings_0.offset_0 = _S6;
    var place_0 : vec2<f32> = (from_0 + to_0) / _S3 + along_0 * vec2<f32>(_S6.x) + vec2<f32>(- along_0.y, along_0.x) * vec2<f32>(_S6.y);
    var _S7 : vec4<f32>;
    if(hidden_0)
    {
        _S7 = vec4<f32>(2.0f, 2.0f, 0.0f, 1.0f);
    }
    else
    {
        _S7 = vec4<f32>(_S3 * place_0 / screen_1, 0.0f, 1.0f);
    }
    varyings_0.position_0 = _S7;
    return varyings_0;
}

@vertex
fn StrokeVert(@builtin(vertex_index) vertex_0 : u32) -> StrokeVaryings_0
{
    var ends_0 : vec2<u32> = strokes_0[vertex_0 / u32(6)];
    return strokeVertex_0(vertex_0 % u32(6), joints_0[ends_0.x].xyz, joints_0[ends_0.y].xyz, Constants_0.width_0, Constants_0.screen_0, mat4x4<f32>(Constants_0.view_projection_0.data_0[i32(0)][i32(0)], Constants_0.view_projection_0.data_0[i32(1)][i32(0)], Constants_0.view_projection_0.data_0[i32(2)][i32(0)], Constants_0.view_projection_0.data_0[i32(3)][i32(0)], Constants_0.view_projection_0.data_0[i32(0)][i32(1)], Constants_0.view_projection_0.data_0[i32(1)][i32(1)], Constants_0.view_projection_0.data_0[i32(2)][i32(1)], Constants_0.view_projection_0.data_0[i32(3)][i32(1)], Constants_0.view_projection_0.data_0[i32(0)][i32(2)], Constants_0.view_projection_0.data_0[i32(1)][i32(2)], Constants_0.view_projection_0.data_0[i32(2)][i32(2)], Constants_0.view_projection_0.data_0[i32(3)][i32(2)], Constants_0.view_projection_0.data_0[i32(0)][i32(3)], Constants_0.view_projection_0.data_0[i32(1)][i32(3)], Constants_0.view_projection_0.data_0[i32(2)][i32(3)], Constants_0.view_projection_0.data_0[i32(3)][i32(3)]));
}

`,
};

/** @type {import("../shader.js").Shader} */
export const StrokeFrag = {
  ...{"stage": "frag", "entry": "StrokeFrag", "buffers": [], "constants": [{"name": "view_projection", "offset": 0, "scalar": "float", "shape": [4, 4], "strides": [4, 16], "used": false}, {"name": "color", "offset": 64, "scalar": "float", "shape": [4], "strides": [4], "used": true}, {"name": "screen", "offset": 80, "scalar": "float", "shape": [2], "strides": [4], "used": false}, {"name": "width", "offset": 88, "scalar": "float", "shape": [], "strides": [], "used": false}], "constants_binding": 2, "threads": [1, 1, 1]},
  code: `struct _MatrixStorage_float4x4_ColMajorstd140_0
{
    @align(16) data_0 : array<vec4<f32>, i32(4)>,
};

struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) view_projection_0 : _MatrixStorage_float4x4_ColMajorstd140_0,
    @align(16) color_0 : vec4<f32>,
    @align(16) screen_0 : vec2<f32>,
    @align(8) width_0 : f32,
};

@binding(2) @group(1) var<uniform> Constants_0 : SLANG_ParameterGroup_Constants_std140_0;
struct StrokeVaryings_0
{
     position_0 : vec4<f32>,
    offset_0 : vec2<f32>,
    extent_0 : vec2<f32>,
};

fn strokeCover_0( varyings_0 : StrokeVaryings_0) -> f32
{
    return saturate(varyings_0.extent_0.y + 0.5f - length(vec2<f32>(max(abs(varyings_0.offset_0.x) - varyings_0.extent_0.x, 0.0f), varyings_0.offset_0.y)));
}

struct pixelOutput_0
{
    @location(0) output_0 : vec4<f32>,
};

struct pixelInput_0
{
    @interpolate(linear) @location(0) offset_1 : vec2<f32>,
    @interpolate(flat) @location(1) extent_1 : vec2<f32>,
};

@fragment
fn StrokeFrag( _S1 : pixelInput_0, @builtin(position) position_1 : vec4<f32>) -> pixelOutput_0
{
    var _S2 : StrokeVaryings_0 = StrokeVaryings_0( position_1, _S1.offset_1, _S1.extent_1 );
    var _S3 : pixelOutput_0 = pixelOutput_0( vec4<f32>(Constants_0.color_0.xyz, 1.0f) * vec4<f32>(strokeCover_0(_S2)) );
    return _S3;
}

`,
};
