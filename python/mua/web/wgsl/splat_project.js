// Generated from ComputeShaders/splat_project.compute by tools/gen_wgsl.py; do not edit.

/** @type {import("../shader.js").Shader} */
export const SplatProject = {
  ...{"stage": "comp", "entry": "SplatProject", "buffers": [{"name": "mesh", "binding": 0, "read_only": true, "scalar": "float", "stride": 4}, {"name": "faces", "binding": 1, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "texels", "binding": 2, "read_only": true, "scalar": "uint", "stride": 8}, {"name": "texel_channels", "binding": 3, "read_only": true, "scalar": "uint", "stride": 8}, {"name": "vertex_dq", "binding": 4, "read_only": true, "scalar": "float", "stride": 16}, {"name": "splats", "binding": 5, "read_only": false, "scalar": "uint", "stride": 16}, {"name": "keys", "binding": 6, "read_only": false, "scalar": "uint", "stride": 4}], "constants": [{"name": "view", "offset": 0, "scalar": "float", "shape": [2, 4, 4], "strides": [64, 4, 16], "used": true}, {"name": "projection", "offset": 128, "scalar": "float", "shape": [2, 4, 4], "strides": [64, 4, 16], "used": true}, {"name": "bounds_low", "offset": 256, "scalar": "float", "shape": [4], "strides": [4], "used": true}, {"name": "bounds_high", "offset": 272, "scalar": "float", "shape": [4], "strides": [4], "used": true}, {"name": "screen", "offset": 288, "scalar": "float", "shape": [2], "strides": [4], "used": true}, {"name": "near", "offset": 296, "scalar": "float", "shape": [], "strides": [], "used": true}, {"name": "eyes", "offset": 300, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "texel_count", "offset": 304, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "first_splat", "offset": 308, "scalar": "uint", "shape": [], "strides": [], "used": true}], "constants_binding": 7, "threads": [256, 1, 1]},
  code: `struct _MatrixStorage_float4x4_ColMajorstd140_0
{
    @align(16) data_0 : array<vec4<f32>, i32(4)>,
};

struct _Array_std140_matrixx3Cfloatx2C4x2C4x3E2_0
{
    @align(16) data_1 : array<_MatrixStorage_float4x4_ColMajorstd140_0, i32(2)>,
};

struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) view_0 : _Array_std140_matrixx3Cfloatx2C4x2C4x3E2_0,
    @align(16) projection_0 : _Array_std140_matrixx3Cfloatx2C4x2C4x3E2_0,
    @align(16) bounds_low_0 : vec4<f32>,
    @align(16) bounds_high_0 : vec4<f32>,
    @align(16) screen_0 : vec2<f32>,
    @align(8) near_0 : f32,
    @align(4) eyes_0 : u32,
    @align(16) texel_count_0 : u32,
    @align(4) first_splat_0 : u32,
};

@binding(7) @group(0) var<uniform> Constants_0 : SLANG_ParameterGroup_Constants_std140_0;
@binding(2) @group(0) var<storage, read> texels_0 : array<vec2<u32>>;

@binding(1) @group(0) var<storage, read> faces_0 : array<u32>;

@binding(4) @group(0) var<storage, read> vertex_dq_0 : array<vec4<f32>>;

@binding(3) @group(0) var<storage, read> texel_channels_0 : array<vec2<u32>>;

@binding(0) @group(0) var<storage, read> mesh_0 : array<f32>;

@binding(5) @group(0) var<storage, read_write> splats_0 : array<vec4<u32>>;

@binding(6) @group(0) var<storage, read_write> keys_0 : array<u32>;

struct DualQuaternion_0
{
     real_0 : vec4<f32>,
     dual_0 : vec4<f32>,
};

fn noTransform_0() -> DualQuaternion_0
{
    var none_0 : DualQuaternion_0;
    var _S1 : vec4<f32> = vec4<f32>(vec4<i32>(i32(0)));
    none_0.real_0 = _S1;
    none_0.dual_0 = _S1;
    return none_0;
}

fn accumulate_0( total_0 : DualQuaternion_0,  real_1 : vec4<f32>,  dual_1 : vec4<f32>,  weight_0 : f32,  reference_0 : vec4<f32>) -> DualQuaternion_0
{
    var _S2 : DualQuaternion_0 = total_0;
    var signedWeight_0 : f32;
    if((dot(real_1, reference_0)) < 0.0f)
    {
        signedWeight_0 = - weight_0;
    }
    else
    {
        signedWeight_0 = weight_0;
    }
    _S2.real_0 = _S2.real_0 + vec4<f32>(signedWeight_0) * real_1;
    _S2.dual_0 = _S2.dual_0 + vec4<f32>(signedWeight_0) * dual_1;
    return _S2;
}

fn normalized_0( total_1 : DualQuaternion_0) -> DualQuaternion_0
{
    var _S3 : DualQuaternion_0 = total_1;
    var _S4 : vec4<f32> = vec4<f32>(max(length(_S3.real_0), 1.17549435082228751e-38f));
    _S3.real_0 = _S3.real_0 / _S4;
    _S3.dual_0 = _S3.dual_0 / _S4;
    return _S3;
}

fn blendTexel_0( corners_0 : vec3<u32>,  barycentric_0 : vec3<f32>) -> DualQuaternion_0
{
    var _S5 : u32 = corners_0.x;
    var _S6 : f32 = barycentric_0.y;
    var _S7 : f32 = barycentric_0.x;
    var nearest_0 : u32;
    if(_S6 > _S7)
    {
        nearest_0 = corners_0.y;
    }
    else
    {
        nearest_0 = _S5;
    }
    if((barycentric_0.z) > (max(_S7, _S6)))
    {
        nearest_0 = corners_0.z;
    }
    var _S8 : vec4<f32> = vertex_dq_0[u32(2) * nearest_0];
    var total_2 : DualQuaternion_0 = noTransform_0();
    var i_0 : u32 = u32(0);
    for(;;)
    {
        if(i_0 < u32(3))
        {
        }
        else
        {
            break;
        }
        var _S9 : u32 = u32(2) * corners_0[i_0];
        var _S10 : DualQuaternion_0 = accumulate_0(total_2, vertex_dq_0[_S9], vertex_dq_0[_S9 + u32(1)], barycentric_0[i_0], _S8);
        var _S11 : u32 = i_0 + u32(1);
        total_2 = _S10;
        i_0 = _S11;
    }
    return normalized_0(total_2);
}

fn halfAt_0( word_0 : u32,  lane_0 : u32) -> f32
{
    return (unpack2x16float(((((word_0 >> ((u32(16) * lane_0)))) & (u32(65535))))).x);
}

fn unpackHalves_0( word_1 : u32) -> vec2<f32>
{
    return vec2<f32>(halfAt_0(word_1, u32(0)), halfAt_0(word_1, u32(1)));
}

fn channels_0( texel_0 : u32,  row_0 : u32) -> vec4<f32>
{
    var words_0 : vec2<u32> = texel_channels_0[row_0 * Constants_0.texel_count_0 + texel_0];
    return vec4<f32>(unpackHalves_0(words_0.x), unpackHalves_0(words_0.y));
}

fn vertexPosition_0( vertex_0 : u32) -> vec3<f32>
{
    var _S12 : u32 = u32(3) * vertex_0;
    return vec3<f32>(mesh_0[_S12], mesh_0[_S12 + u32(1)], mesh_0[_S12 + u32(2)]);
}

fn quaternionRotate_0( q_0 : vec4<f32>,  v_0 : vec3<f32>) -> vec3<f32>
{
    var _S13 : vec3<f32> = q_0.yzw;
    var t_0 : vec3<f32> = vec3<f32>(2.0f) * cross(_S13, v_0);
    return v_0 + vec3<f32>(q_0.x) * t_0 + cross(_S13, t_0);
}

fn quaternionConjugate_0( q_1 : vec4<f32>) -> vec4<f32>
{
    return vec4<f32>(q_1.x, (vec3<f32>(0) - q_1.yzw));
}

fn quaternionMultiply_0( a_0 : vec4<f32>,  b_0 : vec4<f32>) -> vec4<f32>
{
    var _S14 : f32 = a_0.x;
    var _S15 : f32 = b_0.x;
    var _S16 : vec3<f32> = a_0.yzw;
    var _S17 : vec3<f32> = b_0.yzw;
    return vec4<f32>(_S14 * _S15 - dot(_S16, _S17), vec3<f32>(_S14) * _S17 + vec3<f32>(_S15) * _S16 + cross(_S16, _S17));
}

fn dualTransform_0( real_2 : vec4<f32>,  dual_2 : vec4<f32>,  p_0 : vec3<f32>) -> vec3<f32>
{
    return quaternionRotate_0(real_2, p_0) + vec3<f32>(2.0f) * quaternionMultiply_0(dual_2, quaternionConjugate_0(real_2)).yzw;
}

fn scaledAxes_0( q_2 : vec4<f32>,  scale_0 : vec3<f32>,  rows_0 : ptr<function, array<vec3<f32>, i32(3)>>)
{
    var _S18 : vec3<f32> = q_2.yzw;
    var twice_0 : vec3<f32> = vec3<f32>(2.0f) * _S18;
    var squares_0 : vec3<f32> = twice_0 * _S18;
    var turns_0 : vec3<f32> = twice_0 * vec3<f32>(q_2.x);
    var _S19 : f32 = twice_0.x;
    var xy_0 : f32 = _S19 * q_2.z;
    var _S20 : f32 = q_2.w;
    var xz_0 : f32 = _S19 * _S20;
    var yz_0 : f32 = twice_0.y * _S20;
    var _S21 : f32 = squares_0.y;
    var _S22 : f32 = squares_0.z;
    var _S23 : f32 = turns_0.z;
    var _S24 : f32 = turns_0.y;
    (*rows_0)[i32(0)] = scale_0 * vec3<f32>(1.0f - _S21 - _S22, xy_0 - _S23, xz_0 + _S24);
    var _S25 : f32 = 1.0f - squares_0.x;
    var _S26 : f32 = turns_0.x;
    (*rows_0)[i32(1)] = scale_0 * vec3<f32>(xy_0 + _S23, _S25 - _S22, yz_0 - _S26);
    (*rows_0)[i32(2)] = scale_0 * vec3<f32>(xz_0 - _S24, yz_0 + _S26, _S25 - _S21);
    return;
}

fn activatedOpacity_0( logit_0 : f32) -> f32
{
    var small_0 : f32 = exp(- abs(logit_0));
    var _S27 : f32;
    if(logit_0 < 0.0f)
    {
        _S27 = small_0;
    }
    else
    {
        _S27 = 1.0f;
    }
    return _S27 / (1.0f + small_0);
}

struct Gaussian_0
{
     centre_0 : vec3<f32>,
     rows_1 : array<vec3<f32>, i32(3)>,
     opacity_0 : f32,
     rotation_0 : vec4<f32>,
     normal_0 : vec3<f32>,
};

fn poseTexel_0( texel_1 : u32) -> Gaussian_0
{
    var place_0 : vec2<u32> = texels_0[texel_1];
    var _S28 : u32 = place_0.x;
    var face_0 : u32 = u32(3) * ((_S28 & (u32(2147483647))));
    var _S29 : u32 = faces_0[face_0];
    var _S30 : u32 = faces_0[face_0 + u32(1)];
    var _S31 : u32 = faces_0[face_0 + u32(2)];
    var _S32 : u32 = place_0.y;
    var first_0 : vec2<f32> = vec2<f32>(f32((_S32 & (u32(65535)))), f32((_S32 >> (u32(16))))) / vec2<f32>(65535.0f);
    var barycentric_1 : vec3<f32> = vec3<f32>(first_0, max(1.0f - first_0.x - first_0.y, 0.0f));
    var dq_0 : DualQuaternion_0 = blendTexel_0(vec3<u32>(_S29, _S30, _S31), barycentric_1);
    var offset_0 : vec4<f32> = channels_0(texel_1, u32(0));
    var turn_0 : vec4<f32> = channels_0(texel_1, u32(1));
    var scale_1 : vec4<f32> = channels_0(texel_1, u32(2));
    var _S33 : vec3<f32> = vertexPosition_0(_S29);
    var _S34 : vec3<f32> = vertexPosition_0(_S30);
    var _S35 : vec3<f32> = vertexPosition_0(_S31);
    var own_0 : vec4<f32> = vec4<f32>(offset_0.w, turn_0.xyz);
    var own_1 : vec4<f32> = own_0 / vec4<f32>(max(length(own_0), 1.17549435082228751e-38f));
    var gaussian_0 : Gaussian_0;
    var _S36 : vec3<f32> = vec3<f32>(Constants_0.bounds_low_0.w);
    gaussian_0.centre_0 = _S36 * dualTransform_0(dq_0.real_0, dq_0.dual_0, offset_0.xyz + vec3<f32>(barycentric_1.x) * _S33 + vec3<f32>(barycentric_1.y) * _S34 + vec3<f32>(barycentric_1.z) * _S35);
    var deviations_0 : vec3<f32> = _S36 * exp(min(vec3<f32>(turn_0.w, scale_1.xy), vec3<f32>(10.0f)));
    var _S37 : vec4<f32> = quaternionMultiply_0(dq_0.real_0, own_1);
    var _S38 : array<vec3<f32>, i32(3)> = gaussian_0.rows_1;
    scaledAxes_0(_S37, deviations_0, &(_S38));
    gaussian_0.rows_1 = _S38;
    gaussian_0.opacity_0 = activatedOpacity_0(scale_1.z);
    gaussian_0.rotation_0 = dq_0.real_0;
    gaussian_0.normal_0 = vec3<f32>(vec3<i32>(i32(0)));
    if(_S28 >= u32(2147483648))
    {
        gaussian_0.normal_0 = quaternionRotate_0(dq_0.real_0, cross(_S34 - _S33, _S35 - _S33));
    }
    return gaussian_0;
}

fn placeBefore_0( eye_0 : u32,  gaussian_1 : Gaussian_0) -> vec3<f32>
{
    return (((vec4<f32>(gaussian_1.centre_0, 1.0f)) * (mat4x4<f32>(Constants_0.view_0.data_1[eye_0].data_0[i32(0)][i32(0)], Constants_0.view_0.data_1[eye_0].data_0[i32(1)][i32(0)], Constants_0.view_0.data_1[eye_0].data_0[i32(2)][i32(0)], Constants_0.view_0.data_1[eye_0].data_0[i32(3)][i32(0)], Constants_0.view_0.data_1[eye_0].data_0[i32(0)][i32(1)], Constants_0.view_0.data_1[eye_0].data_0[i32(1)][i32(1)], Constants_0.view_0.data_1[eye_0].data_0[i32(2)][i32(1)], Constants_0.view_0.data_1[eye_0].data_0[i32(3)][i32(1)], Constants_0.view_0.data_1[eye_0].data_0[i32(0)][i32(2)], Constants_0.view_0.data_1[eye_0].data_0[i32(1)][i32(2)], Constants_0.view_0.data_1[eye_0].data_0[i32(2)][i32(2)], Constants_0.view_0.data_1[eye_0].data_0[i32(3)][i32(2)], Constants_0.view_0.data_1[eye_0].data_0[i32(0)][i32(3)], Constants_0.view_0.data_1[eye_0].data_0[i32(1)][i32(3)], Constants_0.view_0.data_1[eye_0].data_0[i32(2)][i32(3)], Constants_0.view_0.data_1[eye_0].data_0[i32(3)][i32(3)])))).xyz;
}

fn majorAxis_0( difference_0 : f32,  b_1 : f32,  spread_0 : f32) -> vec2<f32>
{
    var _S39 : vec2<f32> = vec2<f32>(spread_0 + difference_0, b_1);
    var axis_0 : vec2<f32>;
    if(difference_0 < 0.0f)
    {
        var _S40 : f32 = abs(b_1);
        var _S41 : f32;
        if(b_1 < 0.0f)
        {
            _S41 = difference_0 - spread_0;
        }
        else
        {
            _S41 = spread_0 - difference_0;
        }
        axis_0 = vec2<f32>(_S40, _S41);
    }
    else
    {
        axis_0 = _S39;
    }
    if(spread_0 < 9.999999960041972e-13f)
    {
        axis_0 = vec2<f32>(1.0f, 0.0f);
    }
    return normalize(axis_0);
}

struct Ellipse_0
{
     middle_0 : vec2<f32>,
     axis_1 : vec2<f32>,
     deviations_1 : vec2<f32>,
};

fn project_0( gaussian_2 : Gaussian_0,  eye_1 : u32) -> Ellipse_0
{
    var place_1 : vec3<f32> = placeBefore_0(eye_1, gaussian_2);
    var _S42 : f32 = - place_1.z;
    var _S43 : vec2<f32> = vec2<f32>(0.5f);
    const _S44 : vec2<f32> = vec2<f32>(1.0f, -1.0f);
    var focal_0 : vec2<f32> = vec2<f32>(Constants_0.projection_0.data_1[eye_1].data_0[i32(0)][i32(0)], Constants_0.projection_0.data_1[eye_1].data_0[i32(1)][i32(1)]);
    var skew_0 : vec2<f32> = vec2<f32>(Constants_0.projection_0.data_1[eye_1].data_0[i32(2)][i32(0)], Constants_0.projection_0.data_1[eye_1].data_0[i32(2)][i32(1)]);
    var _S45 : vec2<f32> = vec2<f32>(max(_S42, Constants_0.near_0));
    var ndc_0 : vec2<f32> = place_1.xy / _S45 * focal_0 - skew_0;
    var slope_0 : vec2<f32> = (clamp(ndc_0, vec2<f32>(-1.29999995231628418f), vec2<f32>(1.29999995231628418f)) + skew_0) / focal_0;
    var magnification_0 : vec2<f32> = _S43 * Constants_0.screen_0 * _S44 * focal_0 / _S45;
    var column_0 : vec3<f32> = vec3<f32>(magnification_0.x) * (vec3<f32>(Constants_0.view_0.data_1[eye_1].data_0[i32(0)][i32(0)], Constants_0.view_0.data_1[eye_1].data_0[i32(1)][i32(0)], Constants_0.view_0.data_1[eye_1].data_0[i32(2)][i32(0)]) + vec3<f32>(slope_0.x) * vec3<f32>(Constants_0.view_0.data_1[eye_1].data_0[i32(0)][i32(2)], Constants_0.view_0.data_1[eye_1].data_0[i32(1)][i32(2)], Constants_0.view_0.data_1[eye_1].data_0[i32(2)][i32(2)]));
    var row_1 : vec3<f32> = vec3<f32>(magnification_0.y) * (vec3<f32>(Constants_0.view_0.data_1[eye_1].data_0[i32(0)][i32(1)], Constants_0.view_0.data_1[eye_1].data_0[i32(1)][i32(1)], Constants_0.view_0.data_1[eye_1].data_0[i32(2)][i32(1)]) + vec3<f32>(slope_0.y) * vec3<f32>(Constants_0.view_0.data_1[eye_1].data_0[i32(0)][i32(2)], Constants_0.view_0.data_1[eye_1].data_0[i32(1)][i32(2)], Constants_0.view_0.data_1[eye_1].data_0[i32(2)][i32(2)]));
    var across_0 : vec3<f32> = vec3<f32>(column_0.x) * gaussian_2.rows_1[i32(0)] + vec3<f32>(column_0.y) * gaussian_2.rows_1[i32(1)] + vec3<f32>(column_0.z) * gaussian_2.rows_1[i32(2)];
    var down_0 : vec3<f32> = vec3<f32>(row_1.x) * gaussian_2.rows_1[i32(0)] + vec3<f32>(row_1.y) * gaussian_2.rows_1[i32(1)] + vec3<f32>(row_1.z) * gaussian_2.rows_1[i32(2)];
    var a_1 : f32 = dot(across_0, across_0);
    var b_2 : f32 = dot(across_0, down_0);
    var c_0 : f32 = dot(down_0, down_0);
    var mean_0 : f32 = 0.5f * (a_1 + c_0);
    var difference_1 : f32 = 0.5f * (a_1 - c_0);
    var spread_1 : f32 = sqrt(difference_1 * difference_1 + b_2 * b_2);
    var ellipse_0 : Ellipse_0;
    ellipse_0.middle_0 = (ndc_0 * _S44 + vec2<f32>(1.0f)) * _S43 * Constants_0.screen_0;
    ellipse_0.axis_1 = majorAxis_0(difference_1, b_2, spread_1);
    var _S46 : vec2<f32>;
    if(_S42 > (Constants_0.near_0))
    {
        _S46 = sqrt(max(vec2<f32>(mean_0 + spread_1, mean_0 - spread_1), vec2<f32>(0.00009999999747379f)));
    }
    else
    {
        _S46 = vec2<f32>(vec2<i32>(i32(0)));
    }
    ellipse_0.deviations_1 = _S46;
    return ellipse_0;
}

fn isBehind_0( gaussian_3 : Gaussian_0,  eye_2 : u32) -> bool
{
    var place_2 : vec3<f32> = placeBefore_0(eye_2, gaussian_3);
    var normal_1 : vec3<f32> = (((vec4<f32>(gaussian_3.normal_0, 0.0f)) * (mat4x4<f32>(Constants_0.view_0.data_1[eye_2].data_0[i32(0)][i32(0)], Constants_0.view_0.data_1[eye_2].data_0[i32(1)][i32(0)], Constants_0.view_0.data_1[eye_2].data_0[i32(2)][i32(0)], Constants_0.view_0.data_1[eye_2].data_0[i32(3)][i32(0)], Constants_0.view_0.data_1[eye_2].data_0[i32(0)][i32(1)], Constants_0.view_0.data_1[eye_2].data_0[i32(1)][i32(1)], Constants_0.view_0.data_1[eye_2].data_0[i32(2)][i32(1)], Constants_0.view_0.data_1[eye_2].data_0[i32(3)][i32(1)], Constants_0.view_0.data_1[eye_2].data_0[i32(0)][i32(2)], Constants_0.view_0.data_1[eye_2].data_0[i32(1)][i32(2)], Constants_0.view_0.data_1[eye_2].data_0[i32(2)][i32(2)], Constants_0.view_0.data_1[eye_2].data_0[i32(3)][i32(2)], Constants_0.view_0.data_1[eye_2].data_0[i32(0)][i32(3)], Constants_0.view_0.data_1[eye_2].data_0[i32(1)][i32(3)], Constants_0.view_0.data_1[eye_2].data_0[i32(2)][i32(3)], Constants_0.view_0.data_1[eye_2].data_0[i32(3)][i32(3)])))).xyz;
    return (dot(normal_1, place_2)) > (0.25f * length(normal_1) * length(place_2));
}

fn splatWide_0( deviations_2 : vec2<f32>) -> vec2<f32>
{
    return sqrt(deviations_2 * deviations_2 + vec2<f32>(0.10262155532836914f));
}

fn splatExtent_0( axis_2 : vec2<f32>,  wide_0 : vec2<f32>) -> vec2<f32>
{
    var size_0 : vec2<f32> = abs(axis_2);
    var _S47 : f32 = wide_0.y;
    return vec2<f32>(2.0150001049041748f) * (vec2<f32>(_S47) + vec2<f32>(((wide_0.x - _S47) * (size_0.x + size_0.y))) * size_0);
}

fn isSeen_0( ellipse_1 : Ellipse_0,  opacity_1 : f32) -> bool
{
    var extent_0 : vec2<f32> = splatExtent_0(ellipse_1.axis_1, splatWide_0(ellipse_1.deviations_1));
    var onScreen_0 : bool;
    if((all(((ellipse_1.middle_0 + extent_0) > vec2<f32>(0.0f)))))
    {
        onScreen_0 = (all(((ellipse_1.middle_0 - extent_0) < (Constants_0.screen_0))));
    }
    else
    {
        onScreen_0 = false;
    }
    if(onScreen_0)
    {
        onScreen_0 = (ellipse_1.deviations_1.x) > 0.0f;
    }
    else
    {
        onScreen_0 = false;
    }
    if(onScreen_0)
    {
        onScreen_0 = opacity_1 >= 0.00392156885936856f;
    }
    else
    {
        onScreen_0 = false;
    }
    return onScreen_0;
}

fn eyePosition_0( eye_3 : u32) -> vec3<f32>
{
    var _S48 : mat4x4<f32> = mat4x4<f32>(Constants_0.view_0.data_1[eye_3].data_0[i32(0)][i32(0)], Constants_0.view_0.data_1[eye_3].data_0[i32(1)][i32(0)], Constants_0.view_0.data_1[eye_3].data_0[i32(2)][i32(0)], Constants_0.view_0.data_1[eye_3].data_0[i32(3)][i32(0)], Constants_0.view_0.data_1[eye_3].data_0[i32(0)][i32(1)], Constants_0.view_0.data_1[eye_3].data_0[i32(1)][i32(1)], Constants_0.view_0.data_1[eye_3].data_0[i32(2)][i32(1)], Constants_0.view_0.data_1[eye_3].data_0[i32(3)][i32(1)], Constants_0.view_0.data_1[eye_3].data_0[i32(0)][i32(2)], Constants_0.view_0.data_1[eye_3].data_0[i32(1)][i32(2)], Constants_0.view_0.data_1[eye_3].data_0[i32(2)][i32(2)], Constants_0.view_0.data_1[eye_3].data_0[i32(3)][i32(2)], Constants_0.view_0.data_1[eye_3].data_0[i32(0)][i32(3)], Constants_0.view_0.data_1[eye_3].data_0[i32(1)][i32(3)], Constants_0.view_0.data_1[eye_3].data_0[i32(2)][i32(3)], Constants_0.view_0.data_1[eye_3].data_0[i32(3)][i32(3)]);
    return vec3<f32>(- _S48[i32(0)].w) * _S48[i32(0)].xyz - vec3<f32>(_S48[i32(1)].w) * _S48[i32(1)].xyz - vec3<f32>(_S48[i32(2)].w) * _S48[i32(2)].xyz;
}

fn splatColor_0( centre_1 : vec3<f32>,  rotation_1 : vec4<f32>,  sh_0 : array<vec3<f32>, i32(4)>,  camera_0 : vec3<f32>) -> vec3<f32>
{
    var direction_0 : vec3<f32> = centre_1 - camera_0;
    var direction_1 : vec3<f32> = quaternionRotate_0(quaternionConjugate_0(rotation_1), direction_0 / vec3<f32>(max(length(direction_0), 1.00000000317107685e-30f)));
    return max(vec3<f32>(0.5f) + vec3<f32>(0.282094806432724f) * sh_0[i32(0)] + vec3<f32>(0.48860251903533936f) * (vec3<f32>(direction_1.z) * sh_0[i32(2)] - vec3<f32>(direction_1.y) * sh_0[i32(1)] - vec3<f32>(direction_1.x) * sh_0[i32(3)]), vec3<f32>(vec3<i32>(i32(0))));
}

fn colorScale_0( exponent_0 : u32) -> f32
{
    return f32((u32(1) << (exponent_0)));
}

fn packColors_0( first_1 : vec3<f32>,  second_0 : vec3<f32>,  opacity_2 : f32) -> vec2<u32>
{
    var _S49 : vec3<f32> = vec3<f32>(0.5f);
    var mean_1 : vec3<f32> = _S49 * (first_1 + second_0);
    var tint_0 : vec3<f32> = _S49 * (first_1 - second_0);
    var needed_0 : vec3<f32> = max(mean_1, abs(tint_0) * vec3<f32>(16.23809432983398438f));
    var _S50 : f32 = max(max(needed_0.x, needed_0.y), needed_0.z);
    var _S51 : i32;
    if(_S50 > 1.0f)
    {
        _S51 = i32(1);
    }
    else
    {
        _S51 = i32(0);
    }
    var _S52 : i32;
    if(_S50 > 2.0f)
    {
        _S52 = i32(1);
    }
    else
    {
        _S52 = i32(0);
    }
    var _S53 : i32 = _S51 + _S52;
    if(_S50 > 4.0f)
    {
        _S51 = i32(1);
    }
    else
    {
        _S51 = i32(0);
    }
    var exponent_1 : u32 = u32(_S53 + _S51);
    var _S54 : vec3<f32> = vec3<f32>((1023.0f / colorScale_0(exponent_1)));
    var _S55 : vec3<u32> = vec3<u32>(min(mean_1 * _S54, vec3<f32>(vec3<u32>(u32(1023)))) + _S49);
    var _S56 : vec3<u32> = vec3<u32>(clamp(tint_0 * _S54, vec3<f32>(-63.0f), vec3<f32>(63.0f)) + vec3<f32>(64.5f));
    return vec2<u32>(((((((_S55.x) | ((((_S55.y) << (u32(10))))))) | ((((_S55.z) << (u32(20))))))) | (((exponent_1 << (u32(30)))))), (((((u32(opacity_2 * 2047.0f + 0.5f) | ((((_S56.x) << (u32(11))))))) | ((((_S56.y) << (u32(18))))))) | ((((_S56.z) << (u32(25)))))));
}

fn packedColors_0( gaussian_4 : Gaussian_0,  texel_2 : u32) -> vec2<u32>
{
    var first_2 : vec4<f32> = channels_0(texel_2, u32(3));
    var second_1 : vec4<f32> = channels_0(texel_2, u32(4));
    var third_0 : vec4<f32> = channels_0(texel_2, u32(5));
    var sh_1 : array<vec3<f32>, i32(4)> = array<vec3<f32>, i32(4)>( first_2.xyz, vec3<f32>(first_2.w, second_1.xy), vec3<f32>(second_1.zw, third_0.x), third_0.yzw );
    var color_0 : vec3<f32> = splatColor_0(gaussian_4.centre_0, gaussian_4.rotation_0, sh_1, eyePosition_0(u32(0)));
    var other_0 : vec3<f32>;
    if((Constants_0.eyes_0) == u32(2))
    {
        other_0 = splatColor_0(gaussian_4.centre_0, gaussian_4.rotation_0, sh_1, eyePosition_0(u32(1)));
    }
    else
    {
        other_0 = color_0;
    }
    return packColors_0(color_0, other_0, gaussian_4.opacity_0);
}

fn packHalves_0( values_0 : vec2<f32>) -> u32
{
    return ((pack2x16float(vec2f((values_0.x),0.0))) | ((((pack2x16float(vec2f((values_0.y),0.0))) << (u32(16))))));
}

fn packedAxis_0( ellipse_2 : Ellipse_0) -> u32
{
    return packHalves_0(vec2<f32>(min(ellipse_2.deviations_1.x, 65504.0f)) * ellipse_2.axis_1);
}

fn packBounded_0( values_1 : vec2<f32>) -> u32
{
    return packHalves_0(clamp(values_1, vec2<f32>(-65504.0f), vec2<f32>(65504.0f)));
}

fn depthKey_0( centre_2 : vec3<f32>) -> u32
{
    var depthOf_0 : vec4<f32> = (vec4<f32>(0) - vec4<f32>(Constants_0.view_0.data_1[i32(0)].data_0[i32(0)][i32(2)], Constants_0.view_0.data_1[i32(0)].data_0[i32(1)][i32(2)], Constants_0.view_0.data_1[i32(0)].data_0[i32(2)][i32(2)], Constants_0.view_0.data_1[i32(0)].data_0[i32(3)][i32(2)]));
    var depthOf_1 : vec4<f32>;
    if((Constants_0.eyes_0) == u32(2))
    {
        depthOf_1 = vec4<f32>(0.5f) * (depthOf_0 - vec4<f32>(Constants_0.view_0.data_1[i32(1)].data_0[i32(0)][i32(2)], Constants_0.view_0.data_1[i32(1)].data_0[i32(1)][i32(2)], Constants_0.view_0.data_1[i32(1)].data_0[i32(2)][i32(2)], Constants_0.view_0.data_1[i32(1)].data_0[i32(3)][i32(2)]));
    }
    else
    {
        depthOf_1 = depthOf_0;
    }
    var _S57 : vec3<f32> = depthOf_1.xyz;
    var low_0 : vec3<f32> = Constants_0.bounds_low_0.xyz * _S57;
    var high_0 : vec3<f32> = Constants_0.bounds_high_0.xyz * _S57;
    var spare_0 : f32 = 0.5f * distance(Constants_0.bounds_low_0.xyz, Constants_0.bounds_high_0.xyz);
    var _S58 : vec3<f32> = vec3<f32>(vec3<i32>(i32(1)));
    var _S59 : f32 = depthOf_1.w;
    var farthest_0 : f32 = dot(max(low_0, high_0), _S58) + _S59 + spare_0;
    return u32(saturate((farthest_0 - (dot(centre_2, _S57) + _S59)) / max(farthest_0 - max(dot(min(low_0, high_0), _S58) + _S59 - spare_0, Constants_0.near_0), 1.00000000317107685e-30f)) * 65534.0f + 0.5f);
}

fn projectTexel_0( texel_3 : u32) -> u32
{
    var gaussian_5 : Gaussian_0 = poseTexel_0(texel_3);
    var _S60 : Ellipse_0 = project_0(gaussian_5, u32(0));
    var first_3 : Ellipse_0 = _S60;
    var second_2 : Ellipse_0 = _S60;
    if((Constants_0.eyes_0) == u32(2))
    {
        second_2 = project_0(gaussian_5, u32(1));
    }
    var _S61 : bool;
    if(isBehind_0(gaussian_5, u32(0)))
    {
        _S61 = true;
    }
    else
    {
        _S61 = !isSeen_0(first_3, gaussian_5.opacity_0);
    }
    if(_S61)
    {
        first_3.deviations_1 = vec2<f32>(vec2<i32>(i32(0)));
    }
    if(isBehind_0(gaussian_5, Constants_0.eyes_0 - u32(1)))
    {
        _S61 = true;
    }
    else
    {
        _S61 = !isSeen_0(second_2, gaussian_5.opacity_0);
    }
    if(_S61)
    {
        second_2.deviations_1 = vec2<f32>(vec2<i32>(i32(0)));
    }
    var splat_0 : u32 = u32(2) * (Constants_0.first_splat_0 + texel_3);
    splats_0[splat_0] = vec4<u32>((bitcast<vec3<u32>>((gaussian_5.centre_0))), u32(0));
    if((first_3.deviations_1.x) > 0.0f)
    {
        _S61 = true;
    }
    else
    {
        _S61 = (second_2.deviations_1.x) > 0.0f;
    }
    var key_0 : u32;
    if(_S61)
    {
        var color_1 : vec2<u32> = packedColors_0(gaussian_5, texel_3);
        splats_0[splat_0][i32(3)] = color_1.x;
        splats_0[splat_0 + u32(1)] = vec4<u32>(color_1.y, packedAxis_0(first_3), packedAxis_0(second_2), packBounded_0(vec2<f32>(first_3.deviations_1.y, second_2.deviations_1.y)));
        key_0 = depthKey_0(gaussian_5.centre_0);
    }
    else
    {
        key_0 = u32(65535);
    }
    return key_0;
}

var<workgroup> groupKeys_0 : array<u32, i32(256)>;

@compute
@workgroup_size(256, 1, 1)
fn SplatProject(@builtin(global_invocation_id) thread_0 : vec3<u32>, @builtin(workgroup_id) group_0 : vec3<u32>, @builtin(local_invocation_index) place_3 : u32)
{
    var _S62 : u32 = thread_0.x;
    var key_1 : u32;
    if(_S62 < (Constants_0.texel_count_0))
    {
        var _S63 : u32 = projectTexel_0(_S62);
        key_1 = _S63;
    }
    else
    {
        key_1 = u32(65535);
    }
    groupKeys_0[place_3] = key_1;
    workgroupBarrier();
    var pair_0 : u32 = u32(2) * place_3;
    var _S64 : bool;
    if(pair_0 < u32(256))
    {
        _S64 = (u32(256) * group_0.x + pair_0) < (Constants_0.texel_count_0);
    }
    else
    {
        _S64 = false;
    }
    if(_S64)
    {
        keys_0[(Constants_0.first_splat_0 + u32(256) * group_0.x) / u32(2) + place_3] = ((groupKeys_0[pair_0]) | ((((groupKeys_0[pair_0 + u32(1)]) << (u32(16))))));
    }
    return;
}

`,
};
