// Generated from ComputeShaders/expressions.compute by tools/gen_wgsl.py; do not edit.

/** @type {import("../shader.js").Shader} */
export const SumTargets = {
  ...{"stage": "comp", "entry": "SumTargets", "buffers": [{"name": "vertices", "binding": 0, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "starts", "binding": 1, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "expressions", "binding": 2, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "offsets", "binding": 3, "read_only": true, "scalar": "float", "stride": 4}, {"name": "weights", "binding": 4, "read_only": true, "scalar": "float", "stride": 4}, {"name": "moved", "binding": 8, "read_only": false, "scalar": "float", "stride": 4}, {"name": "mesh", "binding": 9, "read_only": false, "scalar": "float", "stride": 4}], "constants": [{"name": "vertex_count", "offset": 0, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "triangle_count", "offset": 4, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "texel_count", "offset": 8, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "splat_count", "offset": 12, "scalar": "uint", "shape": [], "strides": [], "used": false}], "constants_binding": 12, "threads": [64, 1, 1]},
  code: `struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) vertex_count_0 : u32,
    @align(4) triangle_count_0 : u32,
    @align(8) texel_count_0 : u32,
    @align(4) splat_count_0 : u32,
};

@binding(12) @group(0) var<uniform> Constants_0 : SLANG_ParameterGroup_Constants_std140_0;
@binding(1) @group(0) var<storage, read> starts_0 : array<u32>;

@binding(2) @group(0) var<storage, read> expressions_0 : array<u32>;

@binding(4) @group(0) var<storage, read> weights_0 : array<f32>;

@binding(3) @group(0) var<storage, read> offsets_0 : array<f32>;

@binding(0) @group(0) var<storage, read> vertices_0 : array<u32>;

@binding(8) @group(0) var<storage, read_write> moved_0 : array<f32>;

@binding(9) @group(0) var<storage, read_write> mesh_0 : array<f32>;

@compute
@workgroup_size(64, 1, 1)
fn SumTargets(@builtin(global_invocation_id) thread_0 : vec3<u32>)
{
    var _S1 : u32 = thread_0.x;
    if(_S1 >= (Constants_0.vertex_count_0))
    {
        return;
    }
    var _S2 : vec3<f32> = vec3<f32>(vec3<i32>(i32(0)));
    var i_0 : u32 = starts_0[_S1];
    var sum_0 : vec3<f32> = _S2;
    for(;;)
    {
        if(i_0 < starts_0[_S1 + u32(1)])
        {
        }
        else
        {
            break;
        }
        var _S3 : u32 = u32(3) * i_0;
        var sum_1 : vec3<f32> = sum_0 + vec3<f32>(weights_0[expressions_0[i_0]]) * vec3<f32>(offsets_0[_S3], offsets_0[_S3 + u32(1)], offsets_0[_S3 + u32(2)]);
        i_0 = i_0 + u32(1);
        sum_0 = sum_1;
    }
    var _S4 : u32 = u32(3) * vertices_0[_S1];
    var k_0 : u32 = u32(0);
    for(;;)
    {
        if(k_0 < u32(3))
        {
        }
        else
        {
            break;
        }
        var _S5 : u32 = _S4 + k_0;
        moved_0[_S5] = sum_0[k_0];
        mesh_0[_S5] = mesh_0[_S5] + sum_0[k_0];
        k_0 = k_0 + u32(1);
    }
    return;
}

`,
};

/** @type {import("../shader.js").Shader} */
export const BendTriangles = {
  ...{"stage": "comp", "entry": "BendTriangles", "buffers": [{"name": "triangles", "binding": 5, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "faces", "binding": 6, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "moved", "binding": 8, "read_only": false, "scalar": "float", "stride": 4}, {"name": "mesh", "binding": 9, "read_only": false, "scalar": "float", "stride": 4}, {"name": "bends", "binding": 10, "read_only": false, "scalar": "float", "stride": 16}], "constants": [{"name": "vertex_count", "offset": 0, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "triangle_count", "offset": 4, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "texel_count", "offset": 8, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "splat_count", "offset": 12, "scalar": "uint", "shape": [], "strides": [], "used": false}], "constants_binding": 12, "threads": [64, 1, 1]},
  code: `struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) vertex_count_0 : u32,
    @align(4) triangle_count_0 : u32,
    @align(8) texel_count_0 : u32,
    @align(4) splat_count_0 : u32,
};

@binding(12) @group(0) var<uniform> Constants_0 : SLANG_ParameterGroup_Constants_std140_0;
@binding(5) @group(0) var<storage, read> triangles_0 : array<u32>;

@binding(6) @group(0) var<storage, read> faces_0 : array<u32>;

@binding(8) @group(0) var<storage, read_write> moved_0 : array<f32>;

@binding(9) @group(0) var<storage, read_write> mesh_0 : array<f32>;

@binding(10) @group(0) var<storage, read_write> bends_0 : array<vec4<f32>>;

fn howFar_0( vertex_0 : u32) -> vec3<f32>
{
    var _S1 : u32 = u32(3) * vertex_0;
    return vec3<f32>(moved_0[_S1], moved_0[_S1 + u32(1)], moved_0[_S1 + u32(2)]);
}

fn movedVertex_0( vertex_1 : u32) -> vec3<f32>
{
    var _S2 : u32 = u32(3) * vertex_1;
    return vec3<f32>(mesh_0[_S2], mesh_0[_S2 + u32(1)], mesh_0[_S2 + u32(2)]);
}

struct Frame_0
{
     x_0 : vec3<f32>,
     y_0 : vec3<f32>,
     normal_0 : vec3<f32>,
     along_0 : f32,
     shear_0 : f32,
     height_0 : f32,
};

fn frameOf_0( a_0 : vec3<f32>,  b_0 : vec3<f32>,  c_0 : vec3<f32>) -> Frame_0
{
    var frame_0 : Frame_0;
    var _S3 : vec3<f32> = b_0 - a_0;
    var _S4 : f32 = length(_S3);
    frame_0.along_0 = _S4;
    var _S5 : vec3<f32> = _S3 / vec3<f32>(max(_S4, 0.00000999999974738f));
    frame_0.x_0 = _S5;
    var _S6 : vec3<f32> = c_0 - a_0;
    var _S7 : f32 = dot(_S5, _S6);
    frame_0.shear_0 = _S7;
    var across_0 : vec3<f32> = _S6 - vec3<f32>(_S7) * _S5;
    var _S8 : f32 = length(across_0);
    frame_0.height_0 = _S8;
    var _S9 : vec3<f32> = across_0 / vec3<f32>(max(_S8, 0.00000999999974738f));
    frame_0.y_0 = _S9;
    frame_0.normal_0 = cross(_S5, _S9);
    return frame_0;
}

fn holds_0( frame_1 : Frame_0) -> bool
{
    var _S10 : bool;
    if((frame_1.along_0) >= 0.00000999999974738f)
    {
        _S10 = (frame_1.height_0) >= 0.00000999999974738f;
    }
    else
    {
        _S10 = false;
    }
    return _S10;
}

fn quaternionOf_0( x_1 : vec3<f32>,  y_1 : vec3<f32>,  z_0 : vec3<f32>) -> vec4<f32>
{
    var _S11 : f32 = x_1.x;
    var _S12 : f32 = 1.0f + _S11;
    var _S13 : f32 = y_1.y;
    var _S14 : f32 = z_0.z;
    var _S15 : f32 = _S12 + _S13 + _S14;
    var _S16 : f32 = y_1.z;
    var _S17 : f32 = z_0.y;
    var _S18 : f32 = _S16 - _S17;
    var _S19 : f32 = z_0.x;
    var _S20 : f32 = x_1.z;
    var _S21 : f32 = _S19 - _S20;
    var _S22 : f32 = x_1.y;
    var _S23 : f32 = y_1.x;
    var _S24 : f32 = _S22 - _S23;
    var found_0 : vec4<f32> = vec4<f32>(_S15, _S18, _S21, _S24);
    var _S25 : f32 = _S12 - _S13 - _S14;
    var _S26 : f32 = _S22 + _S23;
    var _S27 : f32 = _S20 + _S19;
    var other_0 : vec4<f32> = vec4<f32>(_S18, _S25, _S26, _S27);
    var found_1 : vec4<f32>;
    if(_S25 > _S15)
    {
        found_1 = other_0;
    }
    else
    {
        found_1 = found_0;
    }
    var _S28 : f32 = max(_S15, _S25);
    var _S29 : f32 = 1.0f - _S11;
    var _S30 : f32 = _S29 + _S13 - _S14;
    var _S31 : f32 = _S16 + _S17;
    var other_1 : vec4<f32> = vec4<f32>(_S21, _S26, _S30, _S31);
    if(_S30 > _S28)
    {
        found_1 = other_1;
    }
    var _S32 : f32 = _S29 - _S13 + _S14;
    var other_2 : vec4<f32> = vec4<f32>(_S24, _S27, _S31, _S32);
    if(_S32 > (max(_S28, _S30)))
    {
        found_1 = other_2;
    }
    var _S33 : i32;
    if((found_1.x) < 0.0f)
    {
        _S33 = i32(-1);
    }
    else
    {
        _S33 = i32(1);
    }
    return vec4<f32>(f32(_S33)) * found_1 / vec4<f32>(length(found_1));
}

@compute
@workgroup_size(64, 1, 1)
fn BendTriangles(@builtin(global_invocation_id) thread_0 : vec3<u32>)
{
    var _S34 : u32 = thread_0.x;
    if(_S34 >= (Constants_0.triangle_count_0))
    {
        return;
    }
    var face_0 : u32 = u32(3) * triangles_0[_S34];
    var _S35 : u32 = faces_0[face_0];
    var _S36 : u32 = faces_0[face_0 + u32(1)];
    var _S37 : u32 = faces_0[face_0 + u32(2)];
    var _S38 : vec3<f32> = howFar_0(_S35);
    var _S39 : vec3<f32> = howFar_0(_S36);
    var _S40 : vec3<f32> = howFar_0(_S37);
    var _S41 : vec3<f32> = movedVertex_0(_S35);
    var _S42 : vec3<f32> = movedVertex_0(_S36);
    var _S43 : vec3<f32> = movedVertex_0(_S37);
    var before_0 : Frame_0 = frameOf_0(_S41 - _S38, _S42 - _S39, _S43 - _S40);
    var after_0 : Frame_0 = frameOf_0(_S41, _S42, _S43);
    var _S44 : vec3<f32> = vec3<f32>(0.0f);
    var moves_0 : bool;
    if((any((_S38 != _S44))))
    {
        moves_0 = true;
    }
    else
    {
        moves_0 = (any((_S39 != _S44)));
    }
    if(moves_0)
    {
        moves_0 = true;
    }
    else
    {
        moves_0 = (any((_S40 != _S44)));
    }
    if(!moves_0)
    {
        moves_0 = true;
    }
    else
    {
        moves_0 = !holds_0(before_0);
    }
    if(moves_0)
    {
        moves_0 = true;
    }
    else
    {
        moves_0 = !holds_0(after_0);
    }
    if(moves_0)
    {
        bends_0[u32(4) * _S34] = vec4<f32>(vec4<i32>(i32(0)));
        return;
    }
    var along_1 : f32 = after_0.along_0 / before_0.along_0;
    var shear_1 : f32 = (after_0.shear_0 - along_1 * before_0.shear_0) / before_0.height_0;
    var height_1 : f32 = after_0.height_0 / before_0.height_0;
    var _S45 : f32 = along_1 + height_1;
    var turn_0 : vec2<f32> = vec2<f32>(_S45, - shear_1) / vec2<f32>(length(vec2<f32>(_S45, shear_1)));
    var _S46 : vec3<f32> = vec3<f32>(turn_0.x);
    var _S47 : vec3<f32> = vec3<f32>(turn_0.y);
    var _S48 : vec3<f32> = _S46 * after_0.x_0 + _S47 * after_0.y_0;
    var _S49 : vec3<f32> = _S46 * after_0.y_0 - _S47 * after_0.x_0;
    var turned_0 : array<vec3<f32>, i32(3)>;
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
        var _S50 : vec3<f32> = vec3<f32>(before_0.normal_0[i_0]) * after_0.normal_0;
        turned_0[i_0] = vec3<f32>(before_0.x_0[i_0]) * _S48 + vec3<f32>(before_0.y_0[i_0]) * _S49 + _S50;
        bends_0[u32(4) * _S34 + u32(1) + i_0] = vec4<f32>(vec3<f32>((along_1 * before_0.x_0[i_0] + shear_1 * before_0.y_0[i_0])) * after_0.x_0 + vec3<f32>((height_1 * before_0.y_0[i_0])) * after_0.y_0 + _S50, 0.0f);
        i_0 = i_0 + u32(1);
    }
    bends_0[u32(4) * _S34] = quaternionOf_0(turned_0[i32(0)], turned_0[i32(1)], turned_0[i32(2)]);
    return;
}

`,
};

/** @type {import("../shader.js").Shader} */
export const BendTexels = {
  ...{"stage": "comp", "entry": "BendTexels", "buffers": [{"name": "reached", "binding": 7, "read_only": true, "scalar": "uint", "stride": 8}, {"name": "bends", "binding": 10, "read_only": false, "scalar": "float", "stride": 16}, {"name": "texel_channels", "binding": 11, "read_only": false, "scalar": "uint", "stride": 8}], "constants": [{"name": "vertex_count", "offset": 0, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "triangle_count", "offset": 4, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "texel_count", "offset": 8, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "splat_count", "offset": 12, "scalar": "uint", "shape": [], "strides": [], "used": true}], "constants_binding": 12, "threads": [64, 1, 1]},
  code: `struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) vertex_count_0 : u32,
    @align(4) triangle_count_0 : u32,
    @align(8) texel_count_0 : u32,
    @align(4) splat_count_0 : u32,
};

@binding(12) @group(0) var<uniform> Constants_0 : SLANG_ParameterGroup_Constants_std140_0;
@binding(7) @group(0) var<storage, read> reached_0 : array<vec2<u32>>;

@binding(10) @group(0) var<storage, read_write> bends_0 : array<vec4<f32>>;

@binding(11) @group(0) var<storage, read_write> texel_channels_0 : array<vec2<u32>>;

fn halfAt_0( word_0 : u32,  lane_0 : u32) -> f32
{
    return (unpack2x16float(((((word_0 >> ((u32(16) * lane_0)))) & (u32(65535))))).x);
}

fn unpackHalves_0( word_1 : u32) -> vec2<f32>
{
    return vec2<f32>(halfAt_0(word_1, u32(0)), halfAt_0(word_1, u32(1)));
}

fn quaternionRotate_0( q_0 : vec4<f32>,  v_0 : vec3<f32>) -> vec3<f32>
{
    var _S1 : vec3<f32> = q_0.yzw;
    var t_0 : vec3<f32> = vec3<f32>(2.0f) * cross(_S1, v_0);
    return v_0 + vec3<f32>(q_0.x) * t_0 + cross(_S1, t_0);
}

fn quaternionMultiply_0( a_0 : vec4<f32>,  b_0 : vec4<f32>) -> vec4<f32>
{
    var _S2 : f32 = a_0.x;
    var _S3 : f32 = b_0.x;
    var _S4 : vec3<f32> = a_0.yzw;
    var _S5 : vec3<f32> = b_0.yzw;
    return vec4<f32>(_S2 * _S3 - dot(_S4, _S5), vec3<f32>(_S2) * _S5 + vec3<f32>(_S3) * _S4 + cross(_S4, _S5));
}

fn packHalves_0( values_0 : vec2<f32>) -> u32
{
    return ((pack2x16float(vec2f((values_0.x),0.0))) | ((((pack2x16float(vec2f((values_0.y),0.0))) << (u32(16))))));
}

fn packBounded_0( values_1 : vec2<f32>) -> u32
{
    return packHalves_0(clamp(values_1, vec2<f32>(-65504.0f), vec2<f32>(65504.0f)));
}

@compute
@workgroup_size(64, 1, 1)
fn BendTexels(@builtin(global_invocation_id) thread_0 : vec3<u32>)
{
    var _S6 : u32 = thread_0.x;
    if(_S6 >= (Constants_0.texel_count_0))
    {
        return;
    }
    var texel_0 : u32 = reached_0[_S6].x;
    var bend_0 : u32 = u32(4) * reached_0[_S6].y;
    var turn_0 : vec4<f32> = bends_0[bend_0];
    if((all((bends_0[bend_0] == vec4<f32>(0.0f)))))
    {
        return;
    }
    var _S7 : vec2<u32> = texel_channels_0[u32(2) * Constants_0.splat_count_0 + texel_0];
    var _S8 : u32 = texel_channels_0[texel_0].y;
    var offset_0 : vec3<f32> = vec3<f32>(unpackHalves_0(texel_channels_0[texel_0].x), halfAt_0(_S8, u32(0)));
    var _S9 : u32 = texel_channels_0[Constants_0.splat_count_0 + texel_0].y;
    var rotation_0 : vec4<f32> = vec4<f32>(halfAt_0(_S8, u32(1)), unpackHalves_0(texel_channels_0[Constants_0.splat_count_0 + texel_0].x), halfAt_0(_S9, u32(0)));
    var scale_0 : vec3<f32> = vec3<f32>(halfAt_0(_S9, u32(1)), unpackHalves_0(texel_channels_0[u32(2) * Constants_0.splat_count_0 + texel_0].x));
    var _S10 : vec4<f32> = rotation_0 / vec4<f32>(max(length(rotation_0), 1.17549435082228751e-38f));
    var _S11 : array<vec3<f32>, i32(3)> = array<vec3<f32>, i32(3)>( vec3<f32>(1.0f, 0.0f, 0.0f), vec3<f32>(0.0f, 1.0f, 0.0f), vec3<f32>(0.0f, 0.0f, 1.0f) );
    var k_0 : u32 = u32(0);
    for(;;)
    {
        if(k_0 < u32(3))
        {
        }
        else
        {
            break;
        }
        var axis_0 : vec3<f32> = quaternionRotate_0(_S10, _S11[k_0]);
        scale_0[k_0] = scale_0[k_0] + log(clamp(length(vec3<f32>(axis_0.x) * bends_0[bend_0 + u32(1)].xyz + vec3<f32>(axis_0.y) * bends_0[bend_0 + u32(2)].xyz + vec3<f32>(axis_0.z) * bends_0[bend_0 + u32(3)].xyz), 0.05000000074505806f, 20.0f));
        k_0 = k_0 + u32(1);
    }
    var offset_1 : vec3<f32> = quaternionRotate_0(turn_0, offset_0);
    var rotation_1 : vec4<f32> = quaternionMultiply_0(turn_0, rotation_0);
    texel_channels_0[texel_0] = vec2<u32>(packBounded_0(offset_1.xy), packBounded_0(vec2<f32>(offset_1.z, rotation_1.x)));
    texel_channels_0[Constants_0.splat_count_0 + texel_0] = vec2<u32>(packBounded_0(rotation_1.yz), packBounded_0(vec2<f32>(rotation_1.w, scale_0.x)));
    texel_channels_0[u32(2) * Constants_0.splat_count_0 + texel_0] = vec2<u32>(packBounded_0(scale_0.yz), _S7.y);
    return;
}

`,
};
