// Generated from python/mua/player/shaders/splat.hlsl by tools/gen_wgsl.py; do not edit.

/** @type {import("../shader.js").Shader} */
export const SplatVert = {
  ...{"stage": "vert", "entry": "SplatVert", "buffers": [{"name": "order", "binding": 0, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "splats", "binding": 1, "read_only": true, "scalar": "uint", "stride": 16}], "constants": [{"name": "view_projection", "offset": 0, "scalar": "float", "shape": [4, 4], "strides": [4, 16], "used": true}, {"name": "screen", "offset": 64, "scalar": "float", "shape": [2], "strides": [4], "used": true}, {"name": "eye", "offset": 72, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "corners", "offset": 76, "scalar": "uint", "shape": [], "strides": [], "used": true}], "constants_binding": 2, "threads": [1, 1, 1]},
  code: `struct _MatrixStorage_float4x4_ColMajorstd140_0
{
    @align(16) data_0 : array<vec4<f32>, i32(4)>,
};

struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) view_projection_0 : _MatrixStorage_float4x4_ColMajorstd140_0,
    @align(16) screen_0 : vec2<f32>,
    @align(8) eye_0 : u32,
    @align(4) corners_0 : u32,
};

@binding(2) @group(0) var<uniform> Constants_0 : SLANG_ParameterGroup_Constants_std140_0;
@binding(0) @group(0) var<storage, read> order_0 : array<u32>;

@binding(1) @group(0) var<storage, read> splats_0 : array<vec4<u32>>;

fn colorScale_0( exponent_0 : u32) -> f32
{
    return f32((u32(1) << (exponent_0)));
}

fn unpackColor_0( words_0 : vec2<u32>,  eye_1 : u32) -> vec4<f32>
{
    var _S1 : u32 = words_0.x;
    var _S2 : u32 = words_0.y;
    var tint_0 : vec3<f32> = vec3<f32>((vec3<u32>((_S2 >> (u32(11))), (_S2 >> (u32(18))), (_S2 >> (u32(25)))) & (vec3<u32>(u32(127))))) - vec3<f32>(64.0f);
    var _S3 : vec3<f32> = vec3<f32>((vec3<u32>(_S1, (_S1 >> (u32(10))), (_S1 >> (u32(20)))) & (vec3<u32>(u32(1023)))));
    var _S4 : vec3<f32>;
    if(eye_1 == u32(0))
    {
        _S4 = tint_0;
    }
    else
    {
        _S4 = (vec3<f32>(0) - tint_0);
    }
    return vec4<f32>(max(_S3 + _S4, vec3<f32>(vec3<i32>(i32(0)))) * vec3<f32>((colorScale_0((_S1 >> (u32(30)))) / 1023.0f)), f32((_S2 & (u32(2047)))) / 2047.0f);
}

fn halfAt_0( word_0 : u32,  lane_0 : u32) -> f32
{
    return (unpack2x16float(((((word_0 >> ((u32(16) * lane_0)))) & (u32(65535))))).x);
}

fn unpackHalves_0( word_1 : u32) -> vec2<f32>
{
    return vec2<f32>(halfAt_0(word_1, u32(0)), halfAt_0(word_1, u32(1)));
}

fn splatWide_0( deviations_0 : vec2<f32>) -> vec2<f32>
{
    return sqrt(deviations_0 * deviations_0 + vec2<f32>(0.10262155532836914f));
}

fn splatCorner_0( corner_0 : u32,  corners_1 : u32) -> vec2<f32>
{
    var _S5 : bool = corner_0 == u32(1);
    var right_0 : bool;
    if(_S5)
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
    var _S6 : bool = corner_0 == u32(2);
    var below_0 : bool;
    if(_S6)
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
    var _S7 : i32;
    if(corners_1 == u32(3))
    {
        if(_S5)
        {
            _S7 = i32(3);
        }
        else
        {
            _S7 = i32(-1);
        }
        var _S8 : f32 = f32(_S7);
        if(_S6)
        {
            _S7 = i32(3);
        }
        else
        {
            _S7 = i32(-1);
        }
        return vec2<f32>(_S8, f32(_S7));
    }
    if(right_0)
    {
        _S7 = i32(1);
    }
    else
    {
        _S7 = i32(-1);
    }
    var _S9 : f32 = f32(_S7);
    if(below_0)
    {
        _S7 = i32(1);
    }
    else
    {
        _S7 = i32(-1);
    }
    return vec2<f32>(_S9, f32(_S7));
}

fn splatOffset_0( axis_0 : vec2<f32>,  wide_0 : vec2<f32>,  corner_1 : vec2<f32>) -> vec2<f32>
{
    var _S10 : f32 = wide_0.y;
    return vec2<f32>(2.0150001049041748f) * (vec2<f32>(_S10) * corner_1 + vec2<f32>(((wide_0.x - _S10) * dot(axis_0, corner_1))) * axis_0);
}

fn splatShare_0( deviations_1 : vec2<f32>,  wide_1 : vec2<f32>) -> f32
{
    return 0.87046688795089722f * (deviations_1.x / wide_1.x) * (deviations_1.y / wide_1.y);
}

struct SplatVaryings_0
{
    @builtin(position) position_0 : vec4<f32>,
    @location(0) offset_0 : vec2<f32>,
    @interpolate(flat) @location(1) color_0 : vec4<f32>,
};

fn splatVertex_0( _S11 : u32,  _S12 : u32,  _S13 : u32,  _S14 : vec2<f32>,  _S15 : mat4x4<f32>) -> SplatVaryings_0
{
    var place_0 : u32;
    if(_S12 == u32(3))
    {
        place_0 = _S11 / u32(3);
    }
    else
    {
        place_0 = _S11 / u32(6);
    }
    var splat_0 : u32 = u32(2) * order_0[place_0];
    var head_0 : vec4<u32> = splats_0[splat_0];
    var tail_0 : vec4<u32> = splats_0[splat_0 + u32(1)];
    var color_1 : vec4<f32> = unpackColor_0(vec2<u32>(head_0.w, tail_0.x), _S13);
    var _S16 : u32;
    if(_S13 == u32(0))
    {
        _S16 = tail_0.y;
    }
    else
    {
        _S16 = tail_0.z;
    }
    var major_0 : vec2<f32> = unpackHalves_0(_S16);
    var _S17 : f32 = length(major_0);
    var _S18 : f32 = halfAt_0(tail_0.w, _S13);
    var deviations_2 : vec2<f32> = vec2<f32>(_S17, _S18);
    var axis_1 : vec2<f32> = major_0 / vec2<f32>(max(_S17, 1.17549435082228751e-38f));
    var seen_0 : bool = _S18 > 0.0f;
    var centre_0 : vec3<f32>;
    if(seen_0)
    {
        centre_0 = (bitcast<vec3<f32>>((head_0.xyz)));
    }
    else
    {
        centre_0 = vec3<f32>(vec3<i32>(i32(0)));
    }
    var wide_2 : vec2<f32> = splatWide_0(deviations_2);
    var corner_2 : vec2<f32> = splatCorner_0(_S11 - _S12 * place_0, _S12);
    var clip_0 : vec4<f32> = (((vec4<f32>(centre_0, 1.0f)) * (_S15)));
    var _S19 : f32 = clip_0.w;
    var at_0 : vec2<f32> = clip_0.xy / vec2<f32>(_S19) + splatOffset_0(axis_1, wide_2, corner_2) * vec2<f32>(2.0f, -2.0f) / _S14;
    var depth_0 : f32 = clamp(clip_0.z / _S19, 0.0f, 1.0f);
    var varyings_0 : SplatVaryings_0;
    varyings_0.position_0 = vec4<f32>(2.0f, 2.0f, 0.0f, 1.0f);
    if(seen_0)
    {
        varyings_0.position_0 = vec4<f32>(at_0, depth_0, 1.0f);
    }
    varyings_0.offset_0 = corner_2;
    varyings_0.color_0 = vec4<f32>(color_1.xyz, color_1.w * splatShare_0(deviations_2, wide_2));
    return varyings_0;
}

@vertex
fn SplatVert(@builtin(vertex_index) vertex_0 : u32) -> SplatVaryings_0
{
    return splatVertex_0(vertex_0, Constants_0.corners_0, Constants_0.eye_0, Constants_0.screen_0, mat4x4<f32>(Constants_0.view_projection_0.data_0[i32(0)][i32(0)], Constants_0.view_projection_0.data_0[i32(1)][i32(0)], Constants_0.view_projection_0.data_0[i32(2)][i32(0)], Constants_0.view_projection_0.data_0[i32(3)][i32(0)], Constants_0.view_projection_0.data_0[i32(0)][i32(1)], Constants_0.view_projection_0.data_0[i32(1)][i32(1)], Constants_0.view_projection_0.data_0[i32(2)][i32(1)], Constants_0.view_projection_0.data_0[i32(3)][i32(1)], Constants_0.view_projection_0.data_0[i32(0)][i32(2)], Constants_0.view_projection_0.data_0[i32(1)][i32(2)], Constants_0.view_projection_0.data_0[i32(2)][i32(2)], Constants_0.view_projection_0.data_0[i32(3)][i32(2)], Constants_0.view_projection_0.data_0[i32(0)][i32(3)], Constants_0.view_projection_0.data_0[i32(1)][i32(3)], Constants_0.view_projection_0.data_0[i32(2)][i32(3)], Constants_0.view_projection_0.data_0[i32(3)][i32(3)]));
}

`,
};

/** @type {import("../shader.js").Shader} */
export const CountFrag = {
  ...{"stage": "frag", "entry": "CountFrag", "buffers": [], "constants": [], "constants_binding": null, "threads": [1, 1, 1]},
  code: `struct pixelOutput_0
{
    @location(0) output_0 : vec4<f32>,
};

struct pixelInput_0
{
    @location(0) offset_0 : vec2<f32>,
    @interpolate(flat) @location(1) color_0 : vec4<f32>,
};

@fragment
fn CountFrag( _S1 : pixelInput_0, @builtin(position) position_0 : vec4<f32>) -> pixelOutput_0
{
    var _S2 : pixelOutput_0 = pixelOutput_0( vec4<f32>(1.0f, 0.0f, 0.0f, 0.0f) );
    return _S2;
}

`,
};

/** @type {import("../shader.js").Shader} */
export const SplatFrag = {
  ...{"stage": "frag", "entry": "SplatFrag", "buffers": [], "constants": [], "constants_binding": null, "threads": [1, 1, 1]},
  code: `struct SplatVaryings_0
{
     position_0 : vec4<f32>,
     offset_0 : vec2<f32>,
    color_0 : vec4<f32>,
};

fn splatFragment_0( varyings_0 : SplatVaryings_0) -> vec4<f32>
{
    var _S1 : vec2<f32> = varyings_0.offset_0;
    var window_0 : vec2<f32> = saturate(vec2<f32>(1.0f) - _S1 * _S1);
    var alpha_0 : f32 = varyings_0.color_0.w * window_0.x * window_0.y;
    return vec4<f32>(varyings_0.color_0.xyz * vec3<f32>(alpha_0), alpha_0);
}

struct pixelOutput_0
{
    @location(0) output_0 : vec4<f32>,
};

struct pixelInput_0
{
    @location(0) offset_1 : vec2<f32>,
    @interpolate(flat) @location(1) color_1 : vec4<f32>,
};

@fragment
fn SplatFrag( _S2 : pixelInput_0, @builtin(position) position_1 : vec4<f32>) -> pixelOutput_0
{
    var _S3 : SplatVaryings_0 = SplatVaryings_0( position_1, _S2.offset_1, _S2.color_1 );
    var _S4 : pixelOutput_0 = pixelOutput_0( splatFragment_0(_S3) );
    return _S4;
}

`,
};
