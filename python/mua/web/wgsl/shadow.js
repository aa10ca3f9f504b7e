// Generated from python/mua/player/shaders/shadow.hlsl by tools/gen_wgsl.py; do not edit.

/** @type {import("../shader.js").Shader} */
export const ShadowVert = {
  ...{"stage": "vert", "entry": "ShadowVert", "buffers": [{"name": "vertex_dq", "binding": 0, "read_only": true, "scalar": "float", "stride": 16}, {"name": "mesh", "binding": 1, "read_only": true, "scalar": "float", "stride": 4}], "constants": [{"name": "view_projection", "offset": 0, "scalar": "float", "shape": [4, 4], "strides": [4, 16], "used": false}, {"name": "light", "offset": 64, "scalar": "float", "shape": [4], "strides": [4], "used": true}, {"name": "area", "offset": 80, "scalar": "float", "shape": [4], "strides": [4], "used": true}, {"name": "size", "offset": 96, "scalar": "uint", "shape": [], "strides": [], "used": false}], "constants_binding": 3, "threads": [1, 1, 1]},
  code: `@binding(0) @group(0) var<storage, read> vertex_dq_0 : array<vec4<f32>>;

@binding(1) @group(0) var<storage, read> mesh_0 : array<f32>;

struct _MatrixStorage_float4x4_ColMajorstd140_0
{
    @align(16) data_0 : array<vec4<f32>, i32(4)>,
};

struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) view_projection_0 : _MatrixStorage_float4x4_ColMajorstd140_0,
    @align(16) light_0 : vec4<f32>,
    @align(16) area_0 : vec4<f32>,
    @align(16) size_0 : u32,
};

@binding(3) @group(0) var<uniform> Constants_0 : SLANG_ParameterGroup_Constants_std140_0;
fn quaternionRotate_0( q_0 : vec4<f32>,  v_0 : vec3<f32>) -> vec3<f32>
{
    var _S1 : vec3<f32> = q_0.yzw;
    var t_0 : vec3<f32> = vec3<f32>(2.0f) * cross(_S1, v_0);
    return v_0 + vec3<f32>(q_0.x) * t_0 + cross(_S1, t_0);
}

fn quaternionConjugate_0( q_1 : vec4<f32>) -> vec4<f32>
{
    return vec4<f32>(q_1.x, (vec3<f32>(0) - q_1.yzw));
}

fn quaternionMultiply_0( a_0 : vec4<f32>,  b_0 : vec4<f32>) -> vec4<f32>
{
    var _S2 : f32 = a_0.x;
    var _S3 : f32 = b_0.x;
    var _S4 : vec3<f32> = a_0.yzw;
    var _S5 : vec3<f32> = b_0.yzw;
    return vec4<f32>(_S2 * _S3 - dot(_S4, _S5), vec3<f32>(_S2) * _S5 + vec3<f32>(_S3) * _S4 + cross(_S4, _S5));
}

fn dualTransform_0( real_0 : vec4<f32>,  dual_0 : vec4<f32>,  p_0 : vec3<f32>) -> vec3<f32>
{
    return quaternionRotate_0(real_0, p_0) + vec3<f32>(2.0f) * quaternionMultiply_0(dual_0, quaternionConjugate_0(real_0)).yzw;
}

fn shadowPlace_0( place_0 : vec3<f32>,  light_1 : vec3<f32>,  ground_0 : f32) -> vec3<f32>
{
    return place_0 - light_1 * vec3<f32>(((place_0.y - ground_0) / light_1.y));
}

struct vertexOutput_0
{
    @builtin(position) output_0 : vec4<f32>,
};

fn surfaceVertex_0( _S6 : u32) -> vec3<f32>
{
    var _S7 : u32 = u32(3) * _S6;
    var _S8 : u32 = u32(2) * _S6;
    return dualTransform_0(vertex_dq_0[_S8], vertex_dq_0[_S8 + u32(1)], vec3<f32>(mesh_0[_S7], mesh_0[_S7 + u32(1)], mesh_0[_S7 + u32(2)]));
}

@vertex
fn ShadowVert(@builtin(vertex_index) vertex_0 : u32) -> vertexOutput_0
{
    var share_0 : vec2<f32> = (shadowPlace_0(surfaceVertex_0(vertex_0), Constants_0.light_0.xyz, Constants_0.area_0.w).xz - Constants_0.area_0.xy) / vec2<f32>(Constants_0.area_0.z);
    var _S9 : vertexOutput_0 = vertexOutput_0( vec4<f32>(2.0f * share_0.x - 1.0f, 1.0f - 2.0f * share_0.y, 0.5f, 1.0f) );
    return _S9;
}

`,
};

/** @type {import("../shader.js").Shader} */
export const ShadowFrag = {
  ...{"stage": "frag", "entry": "ShadowFrag", "buffers": [], "constants": [], "constants_binding": null, "threads": [1, 1, 1]},
  code: `struct pixelOutput_0
{
    @location(0) output_0 : vec4<f32>,
};

@fragment
fn ShadowFrag() -> pixelOutput_0
{
    var _S1 : pixelOutput_0 = pixelOutput_0( vec4<f32>(vec4<i32>(i32(1))) );
    return _S1;
}

`,
};

/** @type {import("../shader.js").Shader} */
export const GroundVert = {
  ...{"stage": "vert", "entry": "GroundVert", "buffers": [], "constants": [{"name": "view_projection", "offset": 0, "scalar": "float", "shape": [4, 4], "strides": [4, 16], "used": true}, {"name": "light", "offset": 64, "scalar": "float", "shape": [4], "strides": [4], "used": false}, {"name": "area", "offset": 80, "scalar": "float", "shape": [4], "strides": [4], "used": true}, {"name": "size", "offset": 96, "scalar": "uint", "shape": [], "strides": [], "used": true}], "constants_binding": 3, "threads": [1, 1, 1]},
  code: `struct _MatrixStorage_float4x4_ColMajorstd140_0
{
    @align(16) data_0 : array<vec4<f32>, i32(4)>,
};

struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) view_projection_0 : _MatrixStorage_float4x4_ColMajorstd140_0,
    @align(16) light_0 : vec4<f32>,
    @align(16) area_0 : vec4<f32>,
    @align(16) size_0 : u32,
};

@binding(3) @group(0) var<uniform> Constants_0 : SLANG_ParameterGroup_Constants_std140_0;
struct GroundVaryings_0
{
    @builtin(position) position_0 : vec4<f32>,
    @location(0) at_0 : vec2<f32>,
};

@vertex
fn GroundVert(@builtin(vertex_index) vertex_0 : u32) -> GroundVaryings_0
{
    var _S1 : f32 = f32((vertex_0 & (u32(1))));
    var _S2 : f32 = f32((vertex_0 >> (u32(1))));
    var share_0 : vec2<f32> = vec2<f32>(_S1, _S2);
    var varyings_0 : GroundVaryings_0;
    varyings_0.position_0 = (((vec4<f32>(Constants_0.area_0.x + _S1 * Constants_0.area_0.z, Constants_0.area_0.w, Constants_0.area_0.y + _S2 * Constants_0.area_0.z, 1.0f)) * (mat4x4<f32>(Constants_0.view_projection_0.data_0[i32(0)][i32(0)], Constants_0.view_projection_0.data_0[i32(1)][i32(0)], Constants_0.view_projection_0.data_0[i32(2)][i32(0)], Constants_0.view_projection_0.data_0[i32(3)][i32(0)], Constants_0.view_projection_0.data_0[i32(0)][i32(1)], Constants_0.view_projection_0.data_0[i32(1)][i32(1)], Constants_0.view_projection_0.data_0[i32(2)][i32(1)], Constants_0.view_projection_0.data_0[i32(3)][i32(1)], Constants_0.view_projection_0.data_0[i32(0)][i32(2)], Constants_0.view_projection_0.data_0[i32(1)][i32(2)], Constants_0.view_projection_0.data_0[i32(2)][i32(2)], Constants_0.view_projection_0.data_0[i32(3)][i32(2)], Constants_0.view_projection_0.data_0[i32(0)][i32(3)], Constants_0.view_projection_0.data_0[i32(1)][i32(3)], Constants_0.view_projection_0.data_0[i32(2)][i32(3)], Constants_0.view_projection_0.data_0[i32(3)][i32(3)]))));
    varyings_0.at_0 = share_0 * vec2<f32>(f32(Constants_0.size_0));
    return varyings_0;
}

`,
};

/** @type {import("../shader.js").Shader} */
export const GroundFrag = {
  ...{"stage": "frag", "entry": "GroundFrag", "buffers": [{"name": "mask", "binding": 2, "read_only": true, "scalar": "uint", "stride": 4}], "constants": [{"name": "view_projection", "offset": 0, "scalar": "float", "shape": [4, 4], "strides": [4, 16], "used": false}, {"name": "light", "offset": 64, "scalar": "float", "shape": [4], "strides": [4], "used": true}, {"name": "area", "offset": 80, "scalar": "float", "shape": [4], "strides": [4], "used": false}, {"name": "size", "offset": 96, "scalar": "uint", "shape": [], "strides": [], "used": true}], "constants_binding": 3, "threads": [1, 1, 1]},
  code: `struct _MatrixStorage_float4x4_ColMajorstd140_0
{
    @align(16) data_0 : array<vec4<f32>, i32(4)>,
};

struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) view_projection_0 : _MatrixStorage_float4x4_ColMajorstd140_0,
    @align(16) light_0 : vec4<f32>,
    @align(16) area_0 : vec4<f32>,
    @align(16) size_0 : u32,
};

@binding(3) @group(1) var<uniform> Constants_0 : SLANG_ParameterGroup_Constants_std140_0;
@binding(2) @group(1) var<storage, read> mask_0 : array<u32>;

fn splineWeights_0( t_0 : f32) -> vec4<f32>
{
    var s_0 : f32 = 1.0f - t_0;
    return vec4<f32>(s_0 * s_0 * s_0, 4.0f - 6.0f * t_0 * t_0 + 3.0f * t_0 * t_0 * t_0, 4.0f - 6.0f * s_0 * s_0 + 3.0f * s_0 * s_0 * s_0, t_0 * t_0 * t_0) / vec4<f32>(6.0f);
}

struct pixelOutput_0
{
    @location(0) output_0 : vec4<f32>,
};

struct pixelInput_0
{
    @location(0) at_0 : vec2<f32>,
};

fn shadowCover_0( _S1 : vec2<f32>,  _S2 : u32) -> f32
{
    var low_0 : vec2<f32> = floor(_S1 - vec2<f32>(0.5f));
    var _S3 : vec4<f32> = splineWeights_0(_S1.x - 0.5f - low_0.x);
    var _S4 : vec4<f32> = splineWeights_0(_S1.y - 0.5f - low_0.y);
    var i_0 : i32 = i32(0);
    var cover_0 : f32 = 0.0f;
    for(;;)
    {
        if(i_0 < i32(16))
        {
        }
        else
        {
            break;
        }
        var _S5 : i32 = i_0 % i32(4);
        var place_0 : vec2<i32> = vec2<i32>(low_0) + vec2<i32>(_S5, i_0 / i32(4)) - vec2<i32>(i32(1));
        var inside_0 : bool;
        if((all((place_0 >= vec2<i32>(i32(0))))))
        {
            inside_0 = (all((place_0 < vec2<i32>(i32(_S2)))));
        }
        else
        {
            inside_0 = false;
        }
        var index_0 : u32;
        if(inside_0)
        {
            index_0 = u32(place_0.y) * u32(256) + u32(place_0.x);
        }
        else
        {
            index_0 = u32(0);
        }
        var covered_0 : f32 = f32((((mask_0[index_0 / u32(4)] >> ((u32(8) * (index_0 % u32(4)))))) & (u32(255)))) / 255.0f;
        var _S6 : f32;
        if(inside_0)
        {
            _S6 = covered_0 * _S3[_S5] * _S4[i_0 / i32(4)];
        }
        else
        {
            _S6 = 0.0f;
        }
        var cover_1 : f32 = cover_0 + _S6;
        i_0 = i_0 + i32(1);
        cover_0 = cover_1;
    }
    return cover_0;
}

@fragment
fn GroundFrag( _S7 : pixelInput_0, @builtin(position) position_0 : vec4<f32>) -> pixelOutput_0
{
    var _S8 : pixelOutput_0 = pixelOutput_0( vec4<f32>(0.0f, 0.0f, 0.0f, Constants_0.light_0.w * shadowCover_0(_S7.at_0, Constants_0.size_0)) );
    return _S8;
}

`,
};
