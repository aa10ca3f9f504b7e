// Generated from python/mua/player/shaders/template.hlsl by tools/gen_wgsl.py; do not edit.

/** @type {import("../shader.js").Shader} */
export const TemplateVert = {
  ...{"stage": "vert", "entry": "TemplateVert", "buffers": [{"name": "vertex_dq", "binding": 0, "read_only": true, "scalar": "float", "stride": 16}, {"name": "mesh", "binding": 1, "read_only": true, "scalar": "float", "stride": 4}], "constants": [{"name": "view_projection", "offset": 0, "scalar": "float", "shape": [4, 4], "strides": [4, 16], "used": true}, {"name": "camera", "offset": 64, "scalar": "float", "shape": [4], "strides": [4], "used": true}, {"name": "color", "offset": 80, "scalar": "float", "shape": [4], "strides": [4], "used": false}], "constants_binding": 2, "threads": [1, 1, 1]},
  code: `@binding(0) @group(0) var<storage, read> vertex_dq_0 : array<vec4<f32>>;

@binding(1) @group(0) var<storage, read> mesh_0 : array<f32>;

struct _MatrixStorage_float4x4_ColMajorstd140_0
{
    @align(16) data_0 : array<vec4<f32>, i32(4)>,
};

struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) view_projection_0 : _MatrixStorage_float4x4_ColMajorstd140_0,
    @align(16) camera_0 : vec4<f32>,
    @align(16) color_0 : vec4<f32>,
};

@binding(2) @group(0) var<uniform> Constants_0 : SLANG_ParameterGroup_Constants_std140_0;
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

struct SurfaceVaryings_0
{
    @builtin(position) position_0 : vec4<f32>,
    @location(0) normal_0 : vec3<f32>,
    @location(1) toCamera_0 : vec3<f32>,
};

fn surfaceVaryings_0( place_0 : vec3<f32>,  normal_1 : vec3<f32>,  camera_1 : vec3<f32>,  viewProjection_0 : mat4x4<f32>) -> SurfaceVaryings_0
{
    var toCamera_1 : vec3<f32> = camera_1 - place_0;
    var clip_0 : vec4<f32> = (((vec4<f32>(place_0, 1.0f)) * (viewProjection_0)));
    var clipYielding_0 : vec4<f32> = (((vec4<f32>(place_0 - toCamera_1 * vec3<f32>((0.00999999977648258f / max(length(toCamera_1), 9.99999968265522539e-21f))), 1.0f)) * (viewProjection_0)));
    var varyings_0 : SurfaceVaryings_0;
    var _S6 : f32 = clip_0.w;
    varyings_0.position_0 = vec4<f32>(clip_0.xy, _S6 * clipYielding_0.z / max(clipYielding_0.w, 9.99999968265522539e-21f), _S6);
    varyings_0.normal_0 = normal_1 / vec3<f32>(max(length(normal_1), 9.99999968265522539e-21f));
    varyings_0.toCamera_0 = toCamera_1;
    return varyings_0;
}

fn surfaceVertex_0( _S7 : u32) -> vec3<f32>
{
    var _S8 : u32 = u32(3) * _S7;
    var _S9 : u32 = u32(2) * _S7;
    return dualTransform_0(vertex_dq_0[_S9], vertex_dq_0[_S9 + u32(1)], vec3<f32>(mesh_0[_S8], mesh_0[_S8 + u32(1)], mesh_0[_S8 + u32(2)]));
}

@vertex
fn TemplateVert(@builtin(vertex_index) vertex_0 : u32) -> SurfaceVaryings_0
{
    return surfaceVaryings_0(surfaceVertex_0(vertex_0), vec3<f32>(vec3<i32>(i32(0))), Constants_0.camera_0.xyz, mat4x4<f32>(Constants_0.view_projection_0.data_0[i32(0)][i32(0)], Constants_0.view_projection_0.data_0[i32(1)][i32(0)], Constants_0.view_projection_0.data_0[i32(2)][i32(0)], Constants_0.view_projection_0.data_0[i32(3)][i32(0)], Constants_0.view_projection_0.data_0[i32(0)][i32(1)], Constants_0.view_projection_0.data_0[i32(1)][i32(1)], Constants_0.view_projection_0.data_0[i32(2)][i32(1)], Constants_0.view_projection_0.data_0[i32(3)][i32(1)], Constants_0.view_projection_0.data_0[i32(0)][i32(2)], Constants_0.view_projection_0.data_0[i32(1)][i32(2)], Constants_0.view_projection_0.data_0[i32(2)][i32(2)], Constants_0.view_projection_0.data_0[i32(3)][i32(2)], Constants_0.view_projection_0.data_0[i32(0)][i32(3)], Constants_0.view_projection_0.data_0[i32(1)][i32(3)], Constants_0.view_projection_0.data_0[i32(2)][i32(3)], Constants_0.view_projection_0.data_0[i32(3)][i32(3)]));
}

`,
};

/** @type {import("../shader.js").Shader} */
export const TemplateFrag = {
  ...{"stage": "frag", "entry": "TemplateFrag", "buffers": [], "constants": [{"name": "view_projection", "offset": 0, "scalar": "float", "shape": [4, 4], "strides": [4, 16], "used": false}, {"name": "camera", "offset": 64, "scalar": "float", "shape": [4], "strides": [4], "used": false}, {"name": "color", "offset": 80, "scalar": "float", "shape": [4], "strides": [4], "used": true}], "constants_binding": 2, "threads": [1, 1, 1]},
  code: `struct _MatrixStorage_float4x4_ColMajorstd140_0
{
    @align(16) data_0 : array<vec4<f32>, i32(4)>,
};

struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) view_projection_0 : _MatrixStorage_float4x4_ColMajorstd140_0,
    @align(16) camera_0 : vec4<f32>,
    @align(16) color_0 : vec4<f32>,
};

@binding(2) @group(1) var<uniform> Constants_0 : SLANG_ParameterGroup_Constants_std140_0;
fn facetShade_0( toCamera_0 : vec3<f32>,  color_1 : vec3<f32>) -> vec3<f32>
{
    var normal_0 : vec3<f32> = cross(dpdx(toCamera_0), dpdy(toCamera_0));
    return color_1 * vec3<f32>((0.2800000011920929f + 0.72000002861022949f * abs(dot(normal_0, toCamera_0) / max(length(normal_0) * length(toCamera_0), 9.99999968265522539e-21f))));
}

struct pixelOutput_0
{
    @location(0) output_0 : vec4<f32>,
};

struct pixelInput_0
{
    @location(0) normal_1 : vec3<f32>,
    @location(1) toCamera_1 : vec3<f32>,
};

@fragment
fn TemplateFrag( _S1 : pixelInput_0, @builtin(position) position_0 : vec4<f32>) -> pixelOutput_0
{
    var _S2 : pixelOutput_0 = pixelOutput_0( vec4<f32>(facetShade_0(_S1.toCamera_1, Constants_0.color_0.xyz), 1.0f) );
    return _S2;
}

`,
};
