// Generated from python/mua/player/shaders/surface.hlsl by tools/gen_wgsl.py; do not edit.

/** @type {import("../shader.js").Shader} */
export const SurfaceVert = {
  ...{"stage": "vert", "entry": "SurfaceVert", "buffers": [{"name": "splats", "binding": 0, "read_only": true, "scalar": "uint", "stride": 16}, {"name": "ring_starts", "binding": 1, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "ring", "binding": 2, "read_only": true, "scalar": "uint", "stride": 8}], "constants": [{"name": "view_projection", "offset": 0, "scalar": "float", "shape": [4, 4], "strides": [4, 16], "used": true}, {"name": "camera", "offset": 64, "scalar": "float", "shape": [4], "strides": [4], "used": true}, {"name": "color", "offset": 80, "scalar": "float", "shape": [4], "strides": [4], "used": false}, {"name": "first_splat", "offset": 96, "scalar": "uint", "shape": [], "strides": [], "used": true}], "constants_binding": 3, "threads": [1, 1, 1]},
  code: `struct _MatrixStorage_float4x4_ColMajorstd140_0
{
    @align(16) data_0 : array<vec4<f32>, i32(4)>,
};

struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) view_projection_0 : _MatrixStorage_float4x4_ColMajorstd140_0,
    @align(16) camera_0 : vec4<f32>,
    @align(16) color_0 : vec4<f32>,
    @align(16) first_splat_0 : u32,
};

@binding(3) @group(0) var<uniform> Constants_0 : SLANG_ParameterGroup_Constants_std140_0;
@binding(0) @group(0) var<storage, read> splats_0 : array<vec4<u32>>;

@binding(1) @group(0) var<storage, read> ring_starts_0 : array<u32>;

@binding(2) @group(0) var<storage, read> ring_0 : array<vec2<u32>>;

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
    var _S1 : f32 = clip_0.w;
    varyings_0.position_0 = vec4<f32>(clip_0.xy, _S1 * clipYielding_0.z / max(clipYielding_0.w, 9.99999968265522539e-21f), _S1);
    varyings_0.normal_0 = normal_1 / vec3<f32>(max(length(normal_1), 9.99999968265522539e-21f));
    varyings_0.toCamera_0 = toCamera_1;
    return varyings_0;
}

fn surfaceSplat_0( _S2 : u32) -> vec3<f32>
{
    return (bitcast<vec3<f32>>((splats_0[u32(2) * _S2].xyz)));
}

fn surfaceTexelNormal_0( _S3 : u32,  _S4 : u32) -> vec3<f32>
{
    var _S5 : vec3<f32> = surfaceSplat_0(_S4 + _S3);
    var _S6 : vec3<f32> = vec3<f32>(vec3<i32>(i32(0)));
    var _S7 : u32 = ring_starts_0[_S3 + u32(1)];
    var i_0 : u32 = ring_starts_0[_S3];
    var normal_2 : vec3<f32> = _S6;
    for(;;)
    {
        if(i_0 < _S7)
        {
        }
        else
        {
            break;
        }
        var normal_3 : vec3<f32> = normal_2 + cross(surfaceSplat_0(_S4 + ring_0[i_0].x) - _S5, surfaceSplat_0(_S4 + ring_0[i_0].y) - _S5);
        i_0 = i_0 + u32(1);
        normal_2 = normal_3;
    }
    return normal_2;
}

@vertex
fn SurfaceVert(@builtin(vertex_index) texel_0 : u32) -> SurfaceVaryings_0
{
    return surfaceVaryings_0(surfaceSplat_0(Constants_0.first_splat_0 + texel_0), surfaceTexelNormal_0(texel_0, Constants_0.first_splat_0), Constants_0.camera_0.xyz, mat4x4<f32>(Constants_0.view_projection_0.data_0[i32(0)][i32(0)], Constants_0.view_projection_0.data_0[i32(1)][i32(0)], Constants_0.view_projection_0.data_0[i32(2)][i32(0)], Constants_0.view_projection_0.data_0[i32(3)][i32(0)], Constants_0.view_projection_0.data_0[i32(0)][i32(1)], Constants_0.view_projection_0.data_0[i32(1)][i32(1)], Constants_0.view_projection_0.data_0[i32(2)][i32(1)], Constants_0.view_projection_0.data_0[i32(3)][i32(1)], Constants_0.view_projection_0.data_0[i32(0)][i32(2)], Constants_0.view_projection_0.data_0[i32(1)][i32(2)], Constants_0.view_projection_0.data_0[i32(2)][i32(2)], Constants_0.view_projection_0.data_0[i32(3)][i32(2)], Constants_0.view_projection_0.data_0[i32(0)][i32(3)], Constants_0.view_projection_0.data_0[i32(1)][i32(3)], Constants_0.view_projection_0.data_0[i32(2)][i32(3)], Constants_0.view_projection_0.data_0[i32(3)][i32(3)]));
}

`,
};

/** @type {import("../shader.js").Shader} */
export const SurfaceFrag = {
  ...{"stage": "frag", "entry": "SurfaceFrag", "buffers": [], "constants": [{"name": "view_projection", "offset": 0, "scalar": "float", "shape": [4, 4], "strides": [4, 16], "used": false}, {"name": "camera", "offset": 64, "scalar": "float", "shape": [4], "strides": [4], "used": false}, {"name": "color", "offset": 80, "scalar": "float", "shape": [4], "strides": [4], "used": true}, {"name": "first_splat", "offset": 96, "scalar": "uint", "shape": [], "strides": [], "used": false}], "constants_binding": 3, "threads": [1, 1, 1]},
  code: `struct _MatrixStorage_float4x4_ColMajorstd140_0
{
    @align(16) data_0 : array<vec4<f32>, i32(4)>,
};

struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) view_projection_0 : _MatrixStorage_float4x4_ColMajorstd140_0,
    @align(16) camera_0 : vec4<f32>,
    @align(16) color_0 : vec4<f32>,
    @align(16) first_splat_0 : u32,
};

@binding(3) @group(1) var<uniform> Constants_0 : SLANG_ParameterGroup_Constants_std140_0;
struct SurfaceVaryings_0
{
     position_0 : vec4<f32>,
     normal_0 : vec3<f32>,
     toCamera_0 : vec3<f32>,
};

fn surfaceShade_0( varyings_0 : SurfaceVaryings_0,  color_1 : vec3<f32>) -> vec3<f32>
{
    var facing_0 : f32 = dot(normalize(varyings_0.normal_0), normalize(varyings_0.toCamera_0));
    return color_1 * vec3<f32>((0.2800000011920929f + 0.72000002861022949f * abs(facing_0))) * vec3<f32>(mix(1.0f, 0.44999998807907104f, saturate(- facing_0 / 0.25f)));
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
fn SurfaceFrag( _S1 : pixelInput_0, @builtin(position) position_1 : vec4<f32>) -> pixelOutput_0
{
    var _S2 : SurfaceVaryings_0 = SurfaceVaryings_0( position_1, _S1.normal_1, _S1.toCamera_1 );
    var _S3 : pixelOutput_0 = pixelOutput_0( vec4<f32>(surfaceShade_0(_S2, Constants_0.color_0.xyz), 1.0f) );
    return _S3;
}

`,
};
