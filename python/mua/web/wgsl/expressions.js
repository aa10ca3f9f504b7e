// Generated from ComputeShaders/expressions.compute by tools/gen_wgsl.py; do not edit.

/** @type {import("../shader.js").Shader} */
export const SumTargets = {
  ...{"stage": "comp", "entry": "SumTargets", "buffers": [{"name": "vertices", "binding": 0, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "starts", "binding": 1, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "expressions", "binding": 2, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "changes", "binding": 3, "read_only": true, "scalar": "uint", "stride": 8}, {"name": "weights", "binding": 4, "read_only": true, "scalar": "float", "stride": 4}, {"name": "moved", "binding": 13, "read_only": false, "scalar": "float", "stride": 16}, {"name": "mesh", "binding": 14, "read_only": false, "scalar": "float", "stride": 4}], "constants": [{"name": "static_offset_layout", "offset": 0, "scalar": "uint", "shape": [3], "strides": [4], "used": false}, {"name": "vertex_count", "offset": 12, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "triangle_count", "offset": 16, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "channels", "offset": 20, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "size", "offset": 24, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "factor", "offset": 28, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "reach", "offset": 32, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "delay", "offset": 36, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "texel_count", "offset": 40, "scalar": "uint", "shape": [], "strides": [], "used": false}], "constants_binding": 18, "threads": [64, 1, 1]},
  code: `struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) static_offset_layout_0 : vec3<u32>,
    @align(4) vertex_count_0 : u32,
    @align(16) triangle_count_0 : u32,
    @align(4) channels_0 : u32,
    @align(8) size_0 : u32,
    @align(4) factor_0 : u32,
    @align(16) reach_0 : u32,
    @align(4) delay_0 : u32,
    @align(8) texel_count_0 : u32,
};

@binding(18) @group(0) var<uniform> Constants_0 : SLANG_ParameterGroup_Constants_std140_0;
@binding(1) @group(0) var<storage, read> starts_0 : array<u32>;

@binding(2) @group(0) var<storage, read> expressions_0 : array<u32>;

@binding(4) @group(0) var<storage, read> weights_0 : array<f32>;

@binding(3) @group(0) var<storage, read> changes_0 : array<vec2<u32>>;

@binding(0) @group(0) var<storage, read> vertices_0 : array<u32>;

@binding(13) @group(0) var<storage, read_write> moved_0 : array<vec4<f32>>;

@binding(14) @group(0) var<storage, read_write> mesh_0 : array<f32>;

fn halfAt_0( word_0 : u32,  lane_0 : u32) -> f32
{
    return (unpack2x16float(((((word_0 >> ((u32(16) * lane_0)))) & (u32(65535))))).x);
}

fn unpackHalves_0( word_1 : u32) -> vec2<f32>
{
    return vec2<f32>(halfAt_0(word_1, u32(0)), halfAt_0(word_1, u32(1)));
}

fn unpackFour_0( words_0 : vec2<u32>) -> vec4<f32>
{
    return vec4<f32>(unpackHalves_0(words_0.x), unpackHalves_0(words_0.y));
}

@compute
@workgroup_size(64, 1, 1)
fn SumTargets(@builtin(global_invocation_id) thread_0 : vec3<u32>)
{
    var _S1 : u32 = thread_0.x;
    if(_S1 >= (Constants_0.vertex_count_0))
    {
        return;
    }
    var _S2 : vec4<f32> = vec4<f32>(vec4<i32>(i32(0)));
    var i_0 : u32 = starts_0[_S1];
    var sum_0 : vec4<f32> = _S2;
    for(;;)
    {
        if(i_0 < starts_0[_S1 + u32(1)])
        {
        }
        else
        {
            break;
        }
        var sum_1 : vec4<f32> = sum_0 + vec4<f32>(weights_0[(((expressions_0[i_0 / u32(2)] >> ((u32(16) * ((i_0 & (u32(1)))))))) & (u32(65535)))]) * unpackFour_0(changes_0[i_0]);
        i_0 = i_0 + u32(1);
        sum_0 = sum_1;
    }
    var vertex_0 : u32 = vertices_0[_S1];
    moved_0[vertex_0] = sum_0;
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
        mesh_0[u32(3) * vertex_0 + k_0] = mesh_0[u32(3) * vertex_0 + k_0] + sum_0[k_0];
        k_0 = k_0 + u32(1);
    }
    return;
}

`,
};

/** @type {import("../shader.js").Shader} */
export const BendTriangles = {
  ...{"stage": "comp", "entry": "BendTriangles", "buffers": [{"name": "corners", "binding": 5, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "moved", "binding": 13, "read_only": false, "scalar": "float", "stride": 16}, {"name": "mesh", "binding": 14, "read_only": false, "scalar": "float", "stride": 4}, {"name": "triangle_bends", "binding": 15, "read_only": false, "scalar": "uint", "stride": 8}], "constants": [{"name": "static_offset_layout", "offset": 0, "scalar": "uint", "shape": [3], "strides": [4], "used": false}, {"name": "vertex_count", "offset": 12, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "triangle_count", "offset": 16, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "channels", "offset": 20, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "size", "offset": 24, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "factor", "offset": 28, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "reach", "offset": 32, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "delay", "offset": 36, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "texel_count", "offset": 40, "scalar": "uint", "shape": [], "strides": [], "used": false}], "constants_binding": 18, "threads": [64, 1, 1]},
  code: `struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) static_offset_layout_0 : vec3<u32>,
    @align(4) vertex_count_0 : u32,
    @align(16) triangle_count_0 : u32,
    @align(4) channels_0 : u32,
    @align(8) size_0 : u32,
    @align(4) factor_0 : u32,
    @align(16) reach_0 : u32,
    @align(4) delay_0 : u32,
    @align(8) texel_count_0 : u32,
};

@binding(18) @group(0) var<uniform> Constants_0 : SLANG_ParameterGroup_Constants_std140_0;
@binding(5) @group(0) var<storage, read> corners_0 : array<u32>;

@binding(13) @group(0) var<storage, read_write> moved_0 : array<vec4<f32>>;

@binding(14) @group(0) var<storage, read_write> mesh_0 : array<f32>;

@binding(15) @group(0) var<storage, read_write> triangle_bends_0 : array<vec2<u32>>;

fn movedVertex_0( vertex_0 : u32) -> vec3<f32>
{
    var _S1 : u32 = u32(3) * vertex_0;
    return vec3<f32>(mesh_0[_S1], mesh_0[_S1 + u32(1)], mesh_0[_S1 + u32(2)]);
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
    var _S2 : vec3<f32> = b_0 - a_0;
    var _S3 : f32 = length(_S2);
    frame_0.along_0 = _S3;
    var _S4 : vec3<f32> = _S2 / vec3<f32>(max(_S3, 0.00000999999974738f));
    frame_0.x_0 = _S4;
    var _S5 : vec3<f32> = c_0 - a_0;
    var _S6 : f32 = dot(_S4, _S5);
    frame_0.shear_0 = _S6;
    var across_0 : vec3<f32> = _S5 - vec3<f32>(_S6) * _S4;
    var _S7 : f32 = length(across_0);
    frame_0.height_0 = _S7;
    var _S8 : vec3<f32> = across_0 / vec3<f32>(max(_S7, 0.00000999999974738f));
    frame_0.y_0 = _S8;
    frame_0.normal_0 = cross(_S4, _S8);
    return frame_0;
}

fn holds_0( frame_1 : Frame_0) -> bool
{
    var _S9 : bool;
    if((frame_1.along_0) >= 0.00000999999974738f)
    {
        _S9 = (frame_1.height_0) >= 0.00000999999974738f;
    }
    else
    {
        _S9 = false;
    }
    return _S9;
}

struct Bend_0
{
     turn_0 : vec4<f32>,
     diagonal_0 : vec3<f32>,
     others_0 : vec3<f32>,
     own_0 : vec2<f32>,
};

fn noBend_0() -> Bend_0
{
    var bend_0 : Bend_0;
    bend_0.turn_0 = vec4<f32>(1.0f, 0.0f, 0.0f, 0.0f);
    bend_0.diagonal_0 = vec3<f32>(vec3<i32>(i32(1)));
    bend_0.others_0 = vec3<f32>(vec3<i32>(i32(0)));
    bend_0.own_0 = vec2<f32>(vec2<i32>(i32(0)));
    return bend_0;
}

fn quaternionOf_0( x_1 : vec3<f32>,  y_1 : vec3<f32>,  z_0 : vec3<f32>) -> vec4<f32>
{
    var _S10 : f32 = x_1.x;
    var _S11 : f32 = 1.0f + _S10;
    var _S12 : f32 = y_1.y;
    var _S13 : f32 = z_0.z;
    var _S14 : f32 = _S11 + _S12 + _S13;
    var _S15 : f32 = y_1.z;
    var _S16 : f32 = z_0.y;
    var _S17 : f32 = _S15 - _S16;
    var _S18 : f32 = z_0.x;
    var _S19 : f32 = x_1.z;
    var _S20 : f32 = _S18 - _S19;
    var _S21 : f32 = x_1.y;
    var _S22 : f32 = y_1.x;
    var _S23 : f32 = _S21 - _S22;
    var found_0 : vec4<f32> = vec4<f32>(_S14, _S17, _S20, _S23);
    var _S24 : f32 = _S11 - _S12 - _S13;
    var _S25 : f32 = _S21 + _S22;
    var _S26 : f32 = _S19 + _S18;
    var other_0 : vec4<f32> = vec4<f32>(_S17, _S24, _S25, _S26);
    var found_1 : vec4<f32>;
    if(_S24 > _S14)
    {
        found_1 = other_0;
    }
    else
    {
        found_1 = found_0;
    }
    var _S27 : f32 = max(_S14, _S24);
    var _S28 : f32 = 1.0f - _S10;
    var _S29 : f32 = _S28 + _S12 - _S13;
    var _S30 : f32 = _S15 + _S16;
    var other_1 : vec4<f32> = vec4<f32>(_S20, _S25, _S29, _S30);
    if(_S29 > _S27)
    {
        found_1 = other_1;
    }
    var _S31 : f32 = _S28 - _S12 + _S13;
    var other_2 : vec4<f32> = vec4<f32>(_S23, _S26, _S30, _S31);
    if(_S31 > (max(_S27, _S29)))
    {
        found_1 = other_2;
    }
    var _S32 : i32;
    if((found_1.x) < 0.0f)
    {
        _S32 = i32(-1);
    }
    else
    {
        _S32 = i32(1);
    }
    return vec4<f32>(f32(_S32)) * found_1 / vec4<f32>(length(found_1));
}

fn polar_0( before_0 : Frame_0,  after_0 : Frame_0) -> Bend_0
{
    var along_1 : f32 = after_0.along_0 / before_0.along_0;
    var shear_1 : f32 = (after_0.shear_0 - along_1 * before_0.shear_0) / before_0.height_0;
    var height_1 : f32 = after_0.height_0 / before_0.height_0;
    var _S33 : f32 = along_1 + height_1;
    var turn_1 : vec2<f32> = vec2<f32>(_S33, - shear_1) / vec2<f32>(length(vec2<f32>(_S33, shear_1)));
    var _S34 : f32 = turn_1.x;
    var _S35 : vec3<f32> = vec3<f32>(_S34);
    var _S36 : f32 = turn_1.y;
    var _S37 : vec3<f32> = vec3<f32>(_S36);
    var _S38 : vec3<f32> = _S35 * after_0.x_0 + _S37 * after_0.y_0;
    var _S39 : vec3<f32> = _S35 * after_0.y_0 - _S37 * after_0.x_0;
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
        turned_0[i_0] = vec3<f32>(before_0.x_0[i_0]) * _S38 + vec3<f32>(before_0.y_0[i_0]) * _S39 + vec3<f32>(before_0.normal_0[i_0]) * after_0.normal_0;
        i_0 = i_0 + u32(1);
    }
    var bend_1 : Bend_0;
    bend_1.turn_0 = quaternionOf_0(turned_0[i32(0)], turned_0[i32(1)], turned_0[i32(2)]);
    var _S40 : vec3<f32> = vec3<f32>((_S34 * shear_1 + _S36 * height_1));
    var x_2 : vec3<f32> = vec3<f32>((_S34 * along_1)) * before_0.x_0 + _S40 * before_0.y_0;
    var y_2 : vec3<f32> = _S40 * before_0.x_0 + vec3<f32>((_S34 * height_1 - _S36 * shear_1)) * before_0.y_0;
    var _S41 : vec3<f32> = before_0.normal_0;
    bend_1.diagonal_0 = x_2 * before_0.x_0 + y_2 * before_0.y_0 + _S41 * _S41;
    bend_1.others_0 = x_2.xxy * before_0.x_0.yzz + y_2.xxy * before_0.y_0.yzz + before_0.normal_0.xxy * before_0.normal_0.yzz;
    bend_1.own_0 = vec2<f32>(vec2<i32>(i32(0)));
    return bend_1;
}

fn packHalves_0( values_0 : vec2<f32>) -> u32
{
    return ((pack2x16float(vec2f((values_0.x),0.0))) | ((((pack2x16float(vec2f((values_0.y),0.0))) << (u32(16))))));
}

fn packBounded_0( values_1 : vec2<f32>) -> u32
{
    return packHalves_0(clamp(values_1, vec2<f32>(-65504.0f), vec2<f32>(65504.0f)));
}

fn packFour_0( values_2 : vec4<f32>) -> vec2<u32>
{
    return vec2<u32>(packBounded_0(values_2.xy), packBounded_0(values_2.zw));
}

@compute
@workgroup_size(64, 1, 1)
fn BendTriangles(@builtin(global_invocation_id) thread_0 : vec3<u32>)
{
    var _S42 : u32 = thread_0.x;
    if(_S42 >= (Constants_0.triangle_count_0))
    {
        return;
    }
    var far_0 : array<vec3<f32>, i32(3)>;
    var at_0 : array<vec3<f32>, i32(3)>;
    var i_1 : u32 = u32(0);
    for(;;)
    {
        if(i_1 < u32(3))
        {
        }
        else
        {
            break;
        }
        var vertex_1 : u32 = corners_0[u32(3) * _S42 + i_1];
        far_0[i_1] = moved_0[vertex_1].xyz;
        at_0[i_1] = movedVertex_0(vertex_1);
        i_1 = i_1 + u32(1);
    }
    var before_1 : Frame_0 = frameOf_0(at_0[i32(0)] - far_0[i32(0)], at_0[i32(1)] - far_0[i32(1)], at_0[i32(2)] - far_0[i32(2)]);
    var after_1 : Frame_0 = frameOf_0(at_0[i32(0)], at_0[i32(1)], at_0[i32(2)]);
    var _S43 : vec3<f32> = vec3<f32>(0.0f);
    var moves_0 : bool;
    if((any(((far_0[i32(0)]) != _S43))))
    {
        moves_0 = true;
    }
    else
    {
        moves_0 = (any(((far_0[i32(1)]) != _S43)));
    }
    if(moves_0)
    {
        moves_0 = true;
    }
    else
    {
        moves_0 = (any(((far_0[i32(2)]) != _S43)));
    }
    var isHeld_0 : bool;
    if(holds_0(before_1))
    {
        isHeld_0 = holds_0(after_1);
    }
    else
    {
        isHeld_0 = false;
    }
    var area_0 : f32;
    if(isHeld_0)
    {
        area_0 = min(before_1.along_0 * before_1.height_0, after_1.along_0 * after_1.height_0) / 2.0f;
    }
    else
    {
        area_0 = 0.0f;
    }
    var _S44 : Bend_0 = noBend_0();
    if(moves_0)
    {
    }
    else
    {
        isHeld_0 = false;
    }
    var bend_2 : Bend_0;
    if(isHeld_0)
    {
        bend_2 = polar_0(before_1, after_1);
    }
    else
    {
        bend_2 = _S44;
    }
    var first_0 : u32 = u32(3) * _S42;
    triangle_bends_0[first_0] = packFour_0(bend_2.turn_0);
    triangle_bends_0[first_0 + u32(1)] = packFour_0(vec4<f32>(bend_2.diagonal_0, bend_2.others_0.x));
    var _S45 : vec2<f32> = bend_2.others_0.yz;
    var _S46 : f32 = 1024.0f * sqrt(area_0);
    var _S47 : i32;
    if(moves_0)
    {
        _S47 = i32(1);
    }
    else
    {
        _S47 = i32(0);
    }
    triangle_bends_0[first_0 + u32(2)] = packFour_0(vec4<f32>(_S45, _S46, f32(_S47)));
    return;
}

`,
};

/** @type {import("../shader.js").Shader} */
export const BendVertices = {
  ...{"stage": "comp", "entry": "BendVertices", "buffers": [{"name": "vertices", "binding": 0, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "starts", "binding": 1, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "stars", "binding": 6, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "moved", "binding": 13, "read_only": false, "scalar": "float", "stride": 16}, {"name": "triangle_bends", "binding": 15, "read_only": false, "scalar": "uint", "stride": 8}, {"name": "vertex_bends", "binding": 16, "read_only": false, "scalar": "uint", "stride": 8}], "constants": [{"name": "static_offset_layout", "offset": 0, "scalar": "uint", "shape": [3], "strides": [4], "used": false}, {"name": "vertex_count", "offset": 12, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "triangle_count", "offset": 16, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "channels", "offset": 20, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "size", "offset": 24, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "factor", "offset": 28, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "reach", "offset": 32, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "delay", "offset": 36, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "texel_count", "offset": 40, "scalar": "uint", "shape": [], "strides": [], "used": false}], "constants_binding": 18, "threads": [64, 1, 1]},
  code: `struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) static_offset_layout_0 : vec3<u32>,
    @align(4) vertex_count_0 : u32,
    @align(16) triangle_count_0 : u32,
    @align(4) channels_0 : u32,
    @align(8) size_0 : u32,
    @align(4) factor_0 : u32,
    @align(16) reach_0 : u32,
    @align(4) delay_0 : u32,
    @align(8) texel_count_0 : u32,
};

@binding(18) @group(0) var<uniform> Constants_0 : SLANG_ParameterGroup_Constants_std140_0;
@binding(1) @group(0) var<storage, read> starts_0 : array<u32>;

@binding(6) @group(0) var<storage, read> stars_0 : array<u32>;

@binding(15) @group(0) var<storage, read_write> triangle_bends_0 : array<vec2<u32>>;

@binding(0) @group(0) var<storage, read> vertices_0 : array<u32>;

@binding(16) @group(0) var<storage, read_write> vertex_bends_0 : array<vec2<u32>>;

@binding(13) @group(0) var<storage, read_write> moved_0 : array<vec4<f32>>;

fn halfAt_0( word_0 : u32,  lane_0 : u32) -> f32
{
    return (unpack2x16float(((((word_0 >> ((u32(16) * lane_0)))) & (u32(65535))))).x);
}

fn unpackHalves_0( word_1 : u32) -> vec2<f32>
{
    return vec2<f32>(halfAt_0(word_1, u32(0)), halfAt_0(word_1, u32(1)));
}

fn unpackFour_0( words_0 : vec2<u32>) -> vec4<f32>
{
    return vec4<f32>(unpackHalves_0(words_0.x), unpackHalves_0(words_0.y));
}

struct Bend_0
{
     turn_0 : vec4<f32>,
     diagonal_0 : vec3<f32>,
     others_0 : vec3<f32>,
     own_0 : vec2<f32>,
};

fn unpackBend_0( a_0 : vec2<u32>,  b_0 : vec2<u32>,  c_0 : vec2<u32>) -> Bend_0
{
    var second_0 : vec4<f32> = unpackFour_0(b_0);
    var last_0 : vec4<f32> = unpackFour_0(c_0);
    var bend_0 : Bend_0;
    bend_0.turn_0 = unpackFour_0(a_0);
    bend_0.diagonal_0 = second_0.xyz;
    bend_0.others_0 = vec3<f32>(second_0.w, last_0.xy);
    bend_0.own_0 = last_0.zw;
    return bend_0;
}

fn triangleBend_0( place_0 : u32) -> Bend_0
{
    var at_0 : u32 = u32(3) * place_0;
    return unpackBend_0(triangle_bends_0[at_0], triangle_bends_0[at_0 + u32(1)], triangle_bends_0[at_0 + u32(2)]);
}

fn addTurn_0( sum_0 : vec4<f32>,  turn_1 : vec4<f32>) -> vec4<f32>
{
    var _S1 : i32;
    if((dot(sum_0, turn_1)) < 0.0f)
    {
        _S1 = i32(-1);
    }
    else
    {
        _S1 = i32(1);
    }
    return sum_0 + vec4<f32>(f32(_S1)) * turn_1;
}

fn noBend_0() -> Bend_0
{
    var bend_1 : Bend_0;
    bend_1.turn_0 = vec4<f32>(1.0f, 0.0f, 0.0f, 0.0f);
    bend_1.diagonal_0 = vec3<f32>(vec3<i32>(i32(1)));
    bend_1.others_0 = vec3<f32>(vec3<i32>(i32(0)));
    bend_1.own_0 = vec2<f32>(vec2<i32>(i32(0)));
    return bend_1;
}

fn packHalves_0( values_0 : vec2<f32>) -> u32
{
    return ((pack2x16float(vec2f((values_0.x),0.0))) | ((((pack2x16float(vec2f((values_0.y),0.0))) << (u32(16))))));
}

fn packBounded_0( values_1 : vec2<f32>) -> u32
{
    return packHalves_0(clamp(values_1, vec2<f32>(-65504.0f), vec2<f32>(65504.0f)));
}

fn packFour_0( values_2 : vec4<f32>) -> vec2<u32>
{
    return vec2<u32>(packBounded_0(values_2.xy), packBounded_0(values_2.zw));
}

@compute
@workgroup_size(64, 1, 1)
fn BendVertices(@builtin(global_invocation_id) thread_0 : vec3<u32>)
{
    var _S2 : u32 = thread_0.x;
    if(_S2 >= (Constants_0.vertex_count_0))
    {
        return;
    }
    var _S3 : vec3<f32> = vec3<f32>(vec3<i32>(i32(0)));
    var _S4 : u32 = starts_0[_S2];
    var turn_2 : vec4<f32> = vec4<f32>(vec4<i32>(i32(0)));
    var i_0 : u32 = _S4;
    var diagonal_1 : vec3<f32> = _S3;
    var others_1 : vec3<f32> = _S3;
    var area_0 : f32 = 0.0f;
    var moving_0 : f32 = 0.0f;
    for(;;)
    {
        if(i_0 < starts_0[_S2 + u32(1)])
        {
        }
        else
        {
            break;
        }
        var one_0 : Bend_0 = triangleBend_0(stars_0[i_0]);
        var _S5 : f32 = one_0.own_0.x;
        var own_1 : f32 = _S5 * _S5;
        var _S6 : vec4<f32> = addTurn_0(turn_2, vec4<f32>(own_1) * one_0.turn_0);
        var _S7 : vec3<f32> = vec3<f32>(own_1);
        var diagonal_2 : vec3<f32> = diagonal_1 + _S7 * one_0.diagonal_0;
        var others_2 : vec3<f32> = others_1 + _S7 * one_0.others_0;
        var area_1 : f32 = area_0 + own_1;
        var moving_1 : f32 = moving_0 + one_0.own_0.y;
        var _S8 : u32 = i_0 + u32(1);
        turn_2 = _S6;
        i_0 = _S8;
        diagonal_1 = diagonal_2;
        others_1 = others_2;
        area_0 = area_1;
        moving_0 = moving_1;
    }
    var mean_0 : Bend_0 = noBend_0();
    var state_0 : f32;
    if(moving_0 > 0.0f)
    {
        var _S9 : bool = area_0 > 0.0f;
        if(_S9)
        {
            state_0 = 1.0f / area_0;
        }
        else
        {
            state_0 = 0.0f;
        }
        mean_0.turn_0 = vec4<f32>(state_0) * turn_2;
        mean_0.diagonal_0 = vec3<f32>(state_0) * diagonal_1;
        mean_0.others_0 = vec3<f32>(state_0) * others_1;
        if(_S9)
        {
            area_0 = 1.0f;
        }
        else
        {
            area_0 = 2.0f;
        }
        state_0 = area_0;
    }
    else
    {
        state_0 = 0.0f;
    }
    var vertex_0 : u32 = vertices_0[_S2];
    var first_0 : u32 = u32(3) * vertex_0;
    vertex_bends_0[first_0] = packFour_0(mean_0.turn_0);
    vertex_bends_0[first_0 + u32(1)] = packFour_0(vec4<f32>(mean_0.diagonal_0, mean_0.others_0.x));
    vertex_bends_0[first_0 + u32(2)] = packFour_0(vec4<f32>(mean_0.others_0.yz, moved_0[vertex_0].w, state_0));
    return;
}

`,
};

/** @type {import("../shader.js").Shader} */
export const BendTexels = {
  ...{"stage": "comp", "entry": "BendTexels", "buffers": [{"name": "ll", "binding": 7, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "upsampling", "binding": 8, "read_only": true, "scalar": "float", "stride": 4}, {"name": "tiles", "binding": 9, "read_only": true, "scalar": "uint", "stride": 8}, {"name": "static_offset", "binding": 10, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "faces", "binding": 11, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "texels", "binding": 12, "read_only": true, "scalar": "uint", "stride": 8}, {"name": "vertex_bends", "binding": 16, "read_only": false, "scalar": "uint", "stride": 8}, {"name": "texel_channels", "binding": 17, "read_only": false, "scalar": "uint", "stride": 8}], "constants": [{"name": "static_offset_layout", "offset": 0, "scalar": "uint", "shape": [3], "strides": [4], "used": true}, {"name": "vertex_count", "offset": 12, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "triangle_count", "offset": 16, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "channels", "offset": 20, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "size", "offset": 24, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "factor", "offset": 28, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "reach", "offset": 32, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "delay", "offset": 36, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "texel_count", "offset": 40, "scalar": "uint", "shape": [], "strides": [], "used": true}], "constants_binding": 18, "threads": [16, 16, 1]},
  code: `struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) static_offset_layout_0 : vec3<u32>,
    @align(4) vertex_count_0 : u32,
    @align(16) triangle_count_0 : u32,
    @align(4) channels_0 : u32,
    @align(8) size_0 : u32,
    @align(4) factor_0 : u32,
    @align(16) reach_0 : u32,
    @align(4) delay_0 : u32,
    @align(8) texel_count_0 : u32,
};

@binding(18) @group(0) var<uniform> Constants_0 : SLANG_ParameterGroup_Constants_std140_0;
@binding(9) @group(0) var<storage, read> tiles_0 : array<vec2<u32>>;

@binding(7) @group(0) var<storage, read> ll_0 : array<u32>;

@binding(8) @group(0) var<storage, read> upsampling_0 : array<f32>;

@binding(10) @group(0) var<storage, read> static_offset_0 : array<u32>;

@binding(12) @group(0) var<storage, read> texels_0 : array<vec2<u32>>;

@binding(11) @group(0) var<storage, read> faces_0 : array<u32>;

@binding(16) @group(0) var<storage, read_write> vertex_bends_0 : array<vec2<u32>>;

@binding(17) @group(0) var<storage, read_write> texel_channels_0 : array<vec2<u32>>;

fn cornerOf_0( tile_0 : u32) -> vec2<u32>
{
    return vec2<u32>(u32(16)) * tiles_0[u32(17) * tile_0];
}

fn newestSample_0( position_0 : u32) -> u32
{
    var _S1 : u32 = (position_0 + Constants_0.delay_0) / Constants_0.factor_0;
    return _S1;
}

fn firstSample_0( tile_1 : u32) -> u32
{
    var _S2 : u32 = newestSample_0(cornerOf_0(tile_1).y);
    return _S2;
}

var<workgroup> upsampled_0 : array<vec4<f32>, i32(672)>;

fn rowWords_0( size_1 : u32) -> u32
{
    return (size_1 + u32(1)) / u32(2);
}

fn phase_0( position_1 : u32) -> u32
{
    var _S3 : u32 = (position_1 + Constants_0.delay_0) % Constants_0.factor_0;
    return _S3;
}

fn halfAt_0( word_0 : u32,  lane_0 : u32) -> f32
{
    return (unpack2x16float(((((word_0 >> ((u32(16) * lane_0)))) & (u32(65535))))).x);
}

fn olderSample_0( sample_0 : u32) -> u32
{
    var _S4 : u32;
    if(sample_0 == u32(0))
    {
        _S4 = Constants_0.size_0;
    }
    else
    {
        _S4 = sample_0;
    }
    return _S4 - u32(1);
}

fn sampleAt_0( _S5 : u32,  _S6 : u32) -> f32
{
    return halfAt_0(ll_0[_S5 + _S6 / u32(2)], (_S6 & (u32(1))));
}

fn upsampleRow_0( planes_0 : vec4<u32>,  row_0 : u32,  column_0 : u32) -> vec4<f32>
{
    var _S7 : vec4<u32> = (planes_0 * vec4<u32>(Constants_0.size_0) + vec4<u32>(row_0)) * vec4<u32>(rowWords_0(Constants_0.size_0));
    var _S8 : u32 = newestSample_0(column_0);
    var _S9 : u32 = _S8 % Constants_0.size_0;
    var _S10 : u32 = phase_0(column_0);
    var _S11 : vec4<f32> = vec4<f32>(vec4<i32>(i32(0)));
    var older_0 : u32 = _S9;
    var j_0 : u32 = u32(0);
    var tap_0 : u32 = _S10;
    var sum_0 : vec4<f32> = _S11;
    for(;;)
    {
        if(j_0 < (Constants_0.reach_0))
        {
        }
        else
        {
            break;
        }
        var sum_1 : vec4<f32> = sum_0 + vec4<f32>(upsampling_0[tap_0]) * vec4<f32>(sampleAt_0(_S7.x, older_0), sampleAt_0(_S7.y, older_0), sampleAt_0(_S7.z, older_0), sampleAt_0(_S7.w, older_0));
        var tap_1 : u32 = tap_0 + Constants_0.factor_0;
        var _S12 : u32 = olderSample_0(older_0);
        var _S13 : u32 = j_0 + u32(1);
        older_0 = _S12;
        j_0 = _S13;
        tap_0 = tap_1;
        sum_0 = sum_1;
    }
    return sum_0;
}

fn loadBatch_0( tile_2 : u32,  thread_0 : vec2<u32>,  first_0 : u32)
{
    var _S14 : vec4<u32> = min(vec4<u32>(first_0) + vec4<u32>(u32(0), u32(1), u32(2), u32(3)), vec4<u32>((Constants_0.channels_0 - u32(1))));
    var corner_0 : vec2<u32> = cornerOf_0(tile_2);
    var before_0 : u32 = firstSample_0(tile_2);
    var _S15 : u32 = newestSample_0(corner_0.y + u32(16) - u32(1));
    var _S16 : u32 = _S15 - before_0 + Constants_0.reach_0;
    var i_0 : u32 = thread_0.y;
    for(;;)
    {
        if(i_0 < _S16)
        {
        }
        else
        {
            break;
        }
        var row_1 : u32 = (before_0 + i_0 + Constants_0.reach_0 * Constants_0.size_0 - (Constants_0.reach_0 - u32(1))) % Constants_0.size_0;
        var _S17 : u32 = thread_0.x;
        var _S18 : vec4<f32> = upsampleRow_0(_S14, row_1, corner_0.x + _S17);
        upsampled_0[i_0 * u32(16) + _S17] = _S18;
        i_0 = i_0 + u32(16);
    }
    return;
}

fn upsampleColumn_0( newest_0 : u32,  tap_2 : u32,  column_1 : u32) -> vec4<f32>
{
    var _S19 : vec4<f32> = vec4<f32>(vec4<i32>(i32(0)));
    var j_1 : u32 = u32(0);
    var sum_2 : vec4<f32> = _S19;
    for(;;)
    {
        if(j_1 < (Constants_0.reach_0))
        {
        }
        else
        {
            break;
        }
        var sum_3 : vec4<f32> = sum_2 + vec4<f32>(upsampling_0[Constants_0.factor_0 * j_1 + tap_2]) * upsampled_0[(newest_0 - j_1) * u32(16) + column_1];
        j_1 = j_1 + u32(1);
        sum_2 = sum_3;
    }
    return sum_2;
}

fn batchAt_0( tile_3 : u32,  thread_1 : vec2<u32>) -> vec4<f32>
{
    var position_2 : u32 = cornerOf_0(tile_3).y + thread_1.y;
    var _S20 : u32 = newestSample_0(position_2);
    var _S21 : u32 = firstSample_0(tile_3);
    var newest_1 : u32 = _S20 - _S21 + Constants_0.reach_0 - u32(1);
    var _S22 : u32 = phase_0(position_2);
    return upsampleColumn_0(newest_1, _S22, thread_1.x);
}

fn tileRow_0( tile_4 : u32,  row_2 : u32) -> vec2<u32>
{
    return tiles_0[u32(17) * tile_4 + u32(1) + row_2];
}

fn isIn_0( columns_0 : u32,  column_2 : u32) -> bool
{
    return ((((columns_0 >> (column_2))) & (u32(1)))) != u32(0);
}

fn texelOf_0( run_0 : vec2<u32>,  column_3 : u32) -> u32
{
    return run_0.x + countOneBits(((run_0.y) & ((((u32(1) << (column_3))) - u32(1)))));
}

fn byteAt_0( word_1 : u32,  lane_1 : u32) -> i32
{
    return (i32((word_1 << ((u32(24) - u32(8) * lane_1)))) >> (u32(24)));
}

fn stored_0( _S23 : vec3<u32>,  _S24 : u32) -> f32
{
    var _S25 : u32 = _S23.x;
    var word_2 : u32 = static_offset_0[(_S24 >> (_S25))];
    var lane_2 : u32 = (_S24 & ((((u32(1) << (_S25))) - u32(1))));
    var value_0 : f32;
    if(_S25 == u32(0))
    {
        value_0 = (bitcast<f32>(((word_2 | (lane_2)))));
    }
    else
    {
        if(_S25 == u32(1))
        {
            value_0 = halfAt_0(word_2, lane_2);
        }
        else
        {
            var _S26 : f32 = f32(byteAt_0(word_2, lane_2));
            var _S27 : u32 = _S23.z;
            var _S28 : u32 = _S24 / _S23.y;
            value_0 = _S26 * (bitcast<f32>((static_offset_0[_S27 + _S28])));
        }
    }
    return value_0;
}

fn withStatic_0( values_0 : vec4<f32>,  texel_0 : u32,  first_1 : u32) -> vec4<f32>
{
    var whole_0 : vec4<f32> = vec4<f32>(vec4<i32>(i32(0)));
    var i_1 : u32 = u32(0);
    for(;;)
    {
        if(i_1 < u32(4))
        {
        }
        else
        {
            break;
        }
        var _S29 : u32 = first_1 + i_1;
        if(_S29 < (Constants_0.channels_0))
        {
            var _S30 : f32 = stored_0(Constants_0.static_offset_layout_0, _S29 * Constants_0.texel_count_0 + texel_0);
            whole_0[i_1] = values_0[i_1] + _S30;
        }
        i_1 = i_1 + u32(1);
    }
    return whole_0;
}

fn upsampleRows_0( tile_5 : u32,  thread_2 : vec2<u32>,  rows_0 : ptr<function, array<vec4<f32>, i32(3)>>,  texel_1 : ptr<function, u32>,  inReach_0 : ptr<function, bool>) -> bool
{
    loadBatch_0(tile_5, thread_2, u32(0));
    workgroupBarrier();
    var _S31 : vec4<f32> = batchAt_0(tile_5, thread_2);
    (*rows_0)[i32(0)] = _S31;
    workgroupBarrier();
    loadBatch_0(tile_5, thread_2, u32(4));
    workgroupBarrier();
    var _S32 : vec4<f32> = batchAt_0(tile_5, thread_2);
    (*rows_0)[i32(1)] = _S32;
    workgroupBarrier();
    loadBatch_0(tile_5, thread_2, u32(8));
    workgroupBarrier();
    var _S33 : vec4<f32> = batchAt_0(tile_5, thread_2);
    (*rows_0)[i32(2)] = _S33;
    workgroupBarrier();
    var run_1 : vec2<u32> = tileRow_0(tile_5, thread_2.y);
    var _S34 : u32 = run_1.y;
    var _S35 : u32 = thread_2.x;
    var isValid_0 : bool = isIn_0(_S34, _S35);
    var i_2 : u32;
    if(isValid_0)
    {
        i_2 = texelOf_0(run_1, _S35);
    }
    else
    {
        i_2 = u32(0);
    }
    (*texel_1) = i_2;
    (*inReach_0) = isIn_0((_S34 >> (u32(16))), _S35);
    if(isValid_0)
    {
        i_2 = u32(0);
        for(;;)
        {
            if(i_2 < u32(3))
            {
            }
            else
            {
                break;
            }
            var _S36 : vec4<f32> = withStatic_0((*rows_0)[i_2], (*texel_1), u32(4) * i_2);
            (*rows_0)[i_2] = _S36;
            i_2 = i_2 + u32(1);
        }
    }
    return isValid_0;
}

fn unpackHalves_0( word_3 : u32) -> vec2<f32>
{
    return vec2<f32>(halfAt_0(word_3, u32(0)), halfAt_0(word_3, u32(1)));
}

fn unpackFour_0( words_0 : vec2<u32>) -> vec4<f32>
{
    return vec4<f32>(unpackHalves_0(words_0.x), unpackHalves_0(words_0.y));
}

struct Bend_0
{
     turn_0 : vec4<f32>,
     diagonal_0 : vec3<f32>,
     others_0 : vec3<f32>,
     own_0 : vec2<f32>,
};

fn unpackBend_0( a_0 : vec2<u32>,  b_0 : vec2<u32>,  c_0 : vec2<u32>) -> Bend_0
{
    var second_0 : vec4<f32> = unpackFour_0(b_0);
    var last_0 : vec4<f32> = unpackFour_0(c_0);
    var bend_0 : Bend_0;
    bend_0.turn_0 = unpackFour_0(a_0);
    bend_0.diagonal_0 = second_0.xyz;
    bend_0.others_0 = vec3<f32>(second_0.w, last_0.xy);
    bend_0.own_0 = last_0.zw;
    return bend_0;
}

fn vertexBend_0( vertex_0 : u32) -> Bend_0
{
    var at_0 : u32 = u32(3) * vertex_0;
    return unpackBend_0(vertex_bends_0[at_0], vertex_bends_0[at_0 + u32(1)], vertex_bends_0[at_0 + u32(2)]);
}

fn shareOf_0( vertex_1 : Bend_0,  share_0 : f32) -> Bend_0
{
    var part_0 : Bend_0;
    part_0.turn_0 = vec4<f32>(share_0) * vertex_1.turn_0;
    var _S37 : vec3<f32> = vec3<f32>(share_0);
    part_0.diagonal_0 = _S37 * vertex_1.diagonal_0;
    part_0.others_0 = _S37 * vertex_1.others_0;
    var _S38 : f32;
    if((vertex_1.own_0.y) == 2.0f)
    {
        _S38 = 0.0f;
    }
    else
    {
        _S38 = share_0;
    }
    part_0.own_0 = vec2<f32>(_S38, share_0 * vertex_1.own_0.x);
    return part_0;
}

fn addTurn_0( sum_4 : vec4<f32>,  turn_1 : vec4<f32>) -> vec4<f32>
{
    var _S39 : i32;
    if((dot(sum_4, turn_1)) < 0.0f)
    {
        _S39 = i32(-1);
    }
    else
    {
        _S39 = i32(1);
    }
    return sum_4 + vec4<f32>(f32(_S39)) * turn_1;
}

fn bendAt_0( texel_2 : u32,  bends_0 : ptr<function, bool>) -> Bend_0
{
    var place_0 : vec2<u32> = texels_0[texel_2];
    var face_0 : u32 = u32(3) * (((place_0.x) & (u32(2147483647))));
    var _S40 : u32 = place_0.y;
    var shares_0 : vec2<f32> = vec2<f32>(f32((_S40 & (u32(65535)))), f32((_S40 >> (u32(16))))) / vec2<f32>(65535.0f);
    var barycentric_0 : vec3<f32> = vec3<f32>(shares_0, max(1.0f - shares_0.x - shares_0.y, 0.0f));
    var corner_1 : Bend_0 = vertexBend_0(faces_0[face_0]);
    var sum_5 : Bend_0 = shareOf_0(corner_1, barycentric_0.x);
    (*bends_0) = (corner_1.own_0.y) != 0.0f;
    var i_3 : u32 = u32(1);
    for(;;)
    {
        if(i_3 < u32(3))
        {
        }
        else
        {
            break;
        }
        var corner_2 : Bend_0 = vertexBend_0(faces_0[face_0 + i_3]);
        var part_1 : Bend_0 = shareOf_0(corner_2, barycentric_0[i_3]);
        sum_5.turn_0 = addTurn_0(sum_5.turn_0, part_1.turn_0);
        sum_5.diagonal_0 = sum_5.diagonal_0 + part_1.diagonal_0;
        sum_5.others_0 = sum_5.others_0 + part_1.others_0;
        sum_5.own_0 = sum_5.own_0 + part_1.own_0;
        var _S41 : bool;
        if((*bends_0))
        {
            _S41 = true;
        }
        else
        {
            _S41 = (corner_2.own_0.y) != 0.0f;
        }
        (*bends_0) = _S41;
        i_3 = i_3 + u32(1);
    }
    return sum_5;
}

fn quaternionRotate_0( q_0 : vec4<f32>,  v_0 : vec3<f32>) -> vec3<f32>
{
    var _S42 : vec3<f32> = q_0.yzw;
    var t_0 : vec3<f32> = vec3<f32>(2.0f) * cross(_S42, v_0);
    return v_0 + vec3<f32>(q_0.x) * t_0 + cross(_S42, t_0);
}

fn quaternionMultiply_0( a_1 : vec4<f32>,  b_1 : vec4<f32>) -> vec4<f32>
{
    var _S43 : f32 = a_1.x;
    var _S44 : f32 = b_1.x;
    var _S45 : vec3<f32> = a_1.yzw;
    var _S46 : vec3<f32> = b_1.yzw;
    return vec4<f32>(_S43 * _S44 - dot(_S45, _S46), vec3<f32>(_S43) * _S46 + vec3<f32>(_S44) * _S45 + cross(_S45, _S46));
}

fn packHalves_0( values_1 : vec2<f32>) -> u32
{
    return ((pack2x16float(vec2f((values_1.x),0.0))) | ((((pack2x16float(vec2f((values_1.y),0.0))) << (u32(16))))));
}

fn packBounded_0( values_2 : vec2<f32>) -> u32
{
    return packHalves_0(clamp(values_2, vec2<f32>(-65504.0f), vec2<f32>(65504.0f)));
}

fn writeTexel_0( texel_3 : u32,  row_3 : u32,  values_3 : vec4<f32>)
{
    texel_channels_0[row_3 * Constants_0.texel_count_0 + texel_3] = vec2<u32>(packBounded_0(values_3.xy), packBounded_0(values_3.zw));
    return;
}

fn writeRows_0( texel_4 : u32,  first_2 : u32,  rows_1 : array<vec4<f32>, i32(3)>)
{
    var i_4 : u32 = u32(0);
    for(;;)
    {
        if(i_4 < u32(3))
        {
        }
        else
        {
            break;
        }
        writeTexel_0(texel_4, first_2 + i_4, rows_1[i_4]);
        i_4 = i_4 + u32(1);
    }
    return;
}

@compute
@workgroup_size(16, 16, 1)
fn BendTexels(@builtin(workgroup_id) group_0 : vec3<u32>, @builtin(local_invocation_id) thread_3 : vec3<u32>)
{
    var batches_0 : array<vec4<f32>, i32(3)>;
    var texel_5 : u32;
    var bent_0 : bool;
    var _S47 : bool = upsampleRows_0(group_0.x, thread_3.xy, &(batches_0), &(texel_5), &(bent_0));
    if(!_S47)
    {
        return;
    }
    if(bent_0)
    {
        var bends_1 : bool;
        var bend_1 : Bend_0 = bendAt_0(texel_5, &(bends_1));
        const _S48 : vec4<f32> = vec4<f32>(1.0f, 0.0f, 0.0f, 0.0f);
        batches_0[i32(2)][i32(3)] = bend_1.own_0.y;
        var _S49 : bool;
        if(bends_1)
        {
            _S49 = (bend_1.own_0.x) > 0.0f;
        }
        else
        {
            _S49 = false;
        }
        var mirror_0 : vec4<f32>;
        if(_S49)
        {
            var turn_2 : vec4<f32> = bend_1.turn_0 / vec4<f32>(max(length(bend_1.turn_0), 1.17549435082228751e-38f));
            var rotation_0 : vec4<f32> = vec4<f32>(batches_0[i32(0)].w, batches_0[i32(1)].xyz);
            var _S50 : vec4<f32> = rotation_0 / vec4<f32>(max(length(rotation_0), 1.17549435082228751e-38f));
            var _S51 : vec3<f32> = vec3<f32>(bend_1.diagonal_0.x, bend_1.others_0.xy);
            var _S52 : vec3<f32> = vec3<f32>(bend_1.others_0.x, bend_1.diagonal_0.y, bend_1.others_0.z);
            var _S53 : vec3<f32> = vec3<f32>(bend_1.others_0.yz, bend_1.diagonal_0.z);
            var _S54 : array<vec3<f32>, i32(3)> = array<vec3<f32>, i32(3)>( vec3<f32>(1.0f, 0.0f, 0.0f), vec3<f32>(0.0f, 1.0f, 0.0f), vec3<f32>(0.0f, 0.0f, 1.0f) );
            var _S55 : vec3<f32> = vec3<f32>(vec3<i32>(i32(0)));
            var scale_0 : vec3<f32> = _S55;
            var axis_0 : vec3<f32> = _S55;
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
                var axis_1 : vec3<f32> = quaternionRotate_0(_S50, _S54[k_0]);
                scale_0[k_0] = log(clamp(length(vec3<f32>(axis_1.x) * _S51 + vec3<f32>(axis_1.y) * _S52 + vec3<f32>(axis_1.z) * _S53) / bend_1.own_0.x, 0.05000000074505806f, 20.0f));
                var _S56 : u32 = k_0 + u32(1);
                axis_0 = axis_1;
                k_0 = _S56;
            }
            var turned_0 : vec3<f32> = quaternionRotate_0(turn_2, axis_0);
            var _S57 : vec4<f32> = vec4<f32>(dot(axis_0, turned_0), cross(axis_0, turned_0));
            var rotation_1 : vec4<f32> = quaternionMultiply_0(turn_2, rotation_0);
            batches_0[i32(0)] = vec4<f32>(quaternionRotate_0(turn_2, batches_0[i32(0)].xyz), rotation_1.x);
            batches_0[i32(1)] = vec4<f32>(rotation_1.yzw, batches_0[i32(1)].w + scale_0.x);
            var _S58 : vec2<f32> = batches_0[i32(2)].xy + scale_0.yz;
            batches_0[i32(2)].x = _S58.x;
            batches_0[i32(2)].y = _S58.y;
            mirror_0 = _S57;
        }
        else
        {
            mirror_0 = _S48;
        }
        writeTexel_0(texel_5, u32(3), mirror_0);
    }
    writeRows_0(texel_5, u32(0), batches_0);
    return;
}

`,
};

/** @type {import("../shader.js").Shader} */
export const LightTexels = {
  ...{"stage": "comp", "entry": "LightTexels", "buffers": [{"name": "ll", "binding": 7, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "upsampling", "binding": 8, "read_only": true, "scalar": "float", "stride": 4}, {"name": "tiles", "binding": 9, "read_only": true, "scalar": "uint", "stride": 8}, {"name": "static_offset", "binding": 10, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "texel_channels", "binding": 17, "read_only": false, "scalar": "uint", "stride": 8}], "constants": [{"name": "static_offset_layout", "offset": 0, "scalar": "uint", "shape": [3], "strides": [4], "used": true}, {"name": "vertex_count", "offset": 12, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "triangle_count", "offset": 16, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "channels", "offset": 20, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "size", "offset": 24, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "factor", "offset": 28, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "reach", "offset": 32, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "delay", "offset": 36, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "texel_count", "offset": 40, "scalar": "uint", "shape": [], "strides": [], "used": true}], "constants_binding": 18, "threads": [16, 16, 1]},
  code: `struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) static_offset_layout_0 : vec3<u32>,
    @align(4) vertex_count_0 : u32,
    @align(16) triangle_count_0 : u32,
    @align(4) channels_0 : u32,
    @align(8) size_0 : u32,
    @align(4) factor_0 : u32,
    @align(16) reach_0 : u32,
    @align(4) delay_0 : u32,
    @align(8) texel_count_0 : u32,
};

@binding(18) @group(0) var<uniform> Constants_0 : SLANG_ParameterGroup_Constants_std140_0;
@binding(9) @group(0) var<storage, read> tiles_0 : array<vec2<u32>>;

@binding(7) @group(0) var<storage, read> ll_0 : array<u32>;

@binding(8) @group(0) var<storage, read> upsampling_0 : array<f32>;

@binding(10) @group(0) var<storage, read> static_offset_0 : array<u32>;

@binding(17) @group(0) var<storage, read_write> texel_channels_0 : array<vec2<u32>>;

fn cornerOf_0( tile_0 : u32) -> vec2<u32>
{
    return vec2<u32>(u32(16)) * tiles_0[u32(17) * tile_0];
}

fn newestSample_0( position_0 : u32) -> u32
{
    var _S1 : u32 = (position_0 + Constants_0.delay_0) / Constants_0.factor_0;
    return _S1;
}

fn firstSample_0( tile_1 : u32) -> u32
{
    var _S2 : u32 = newestSample_0(cornerOf_0(tile_1).y);
    return _S2;
}

var<workgroup> upsampled_0 : array<vec4<f32>, i32(672)>;

fn rowWords_0( size_1 : u32) -> u32
{
    return (size_1 + u32(1)) / u32(2);
}

fn phase_0( position_1 : u32) -> u32
{
    var _S3 : u32 = (position_1 + Constants_0.delay_0) % Constants_0.factor_0;
    return _S3;
}

fn halfAt_0( word_0 : u32,  lane_0 : u32) -> f32
{
    return (unpack2x16float(((((word_0 >> ((u32(16) * lane_0)))) & (u32(65535))))).x);
}

fn olderSample_0( sample_0 : u32) -> u32
{
    var _S4 : u32;
    if(sample_0 == u32(0))
    {
        _S4 = Constants_0.size_0;
    }
    else
    {
        _S4 = sample_0;
    }
    return _S4 - u32(1);
}

fn sampleAt_0( _S5 : u32,  _S6 : u32) -> f32
{
    return halfAt_0(ll_0[_S5 + _S6 / u32(2)], (_S6 & (u32(1))));
}

fn upsampleRow_0( planes_0 : vec4<u32>,  row_0 : u32,  column_0 : u32) -> vec4<f32>
{
    var _S7 : vec4<u32> = (planes_0 * vec4<u32>(Constants_0.size_0) + vec4<u32>(row_0)) * vec4<u32>(rowWords_0(Constants_0.size_0));
    var _S8 : u32 = newestSample_0(column_0);
    var _S9 : u32 = _S8 % Constants_0.size_0;
    var _S10 : u32 = phase_0(column_0);
    var _S11 : vec4<f32> = vec4<f32>(vec4<i32>(i32(0)));
    var older_0 : u32 = _S9;
    var j_0 : u32 = u32(0);
    var tap_0 : u32 = _S10;
    var sum_0 : vec4<f32> = _S11;
    for(;;)
    {
        if(j_0 < (Constants_0.reach_0))
        {
        }
        else
        {
            break;
        }
        var sum_1 : vec4<f32> = sum_0 + vec4<f32>(upsampling_0[tap_0]) * vec4<f32>(sampleAt_0(_S7.x, older_0), sampleAt_0(_S7.y, older_0), sampleAt_0(_S7.z, older_0), sampleAt_0(_S7.w, older_0));
        var tap_1 : u32 = tap_0 + Constants_0.factor_0;
        var _S12 : u32 = olderSample_0(older_0);
        var _S13 : u32 = j_0 + u32(1);
        older_0 = _S12;
        j_0 = _S13;
        tap_0 = tap_1;
        sum_0 = sum_1;
    }
    return sum_0;
}

fn loadBatch_0( tile_2 : u32,  thread_0 : vec2<u32>,  first_0 : u32)
{
    var _S14 : vec4<u32> = min(vec4<u32>(first_0) + vec4<u32>(u32(0), u32(1), u32(2), u32(3)), vec4<u32>((Constants_0.channels_0 - u32(1))));
    var corner_0 : vec2<u32> = cornerOf_0(tile_2);
    var before_0 : u32 = firstSample_0(tile_2);
    var _S15 : u32 = newestSample_0(corner_0.y + u32(16) - u32(1));
    var _S16 : u32 = _S15 - before_0 + Constants_0.reach_0;
    var i_0 : u32 = thread_0.y;
    for(;;)
    {
        if(i_0 < _S16)
        {
        }
        else
        {
            break;
        }
        var row_1 : u32 = (before_0 + i_0 + Constants_0.reach_0 * Constants_0.size_0 - (Constants_0.reach_0 - u32(1))) % Constants_0.size_0;
        var _S17 : u32 = thread_0.x;
        var _S18 : vec4<f32> = upsampleRow_0(_S14, row_1, corner_0.x + _S17);
        upsampled_0[i_0 * u32(16) + _S17] = _S18;
        i_0 = i_0 + u32(16);
    }
    return;
}

fn upsampleColumn_0( newest_0 : u32,  tap_2 : u32,  column_1 : u32) -> vec4<f32>
{
    var _S19 : vec4<f32> = vec4<f32>(vec4<i32>(i32(0)));
    var j_1 : u32 = u32(0);
    var sum_2 : vec4<f32> = _S19;
    for(;;)
    {
        if(j_1 < (Constants_0.reach_0))
        {
        }
        else
        {
            break;
        }
        var sum_3 : vec4<f32> = sum_2 + vec4<f32>(upsampling_0[Constants_0.factor_0 * j_1 + tap_2]) * upsampled_0[(newest_0 - j_1) * u32(16) + column_1];
        j_1 = j_1 + u32(1);
        sum_2 = sum_3;
    }
    return sum_2;
}

fn batchAt_0( tile_3 : u32,  thread_1 : vec2<u32>) -> vec4<f32>
{
    var position_2 : u32 = cornerOf_0(tile_3).y + thread_1.y;
    var _S20 : u32 = newestSample_0(position_2);
    var _S21 : u32 = firstSample_0(tile_3);
    var newest_1 : u32 = _S20 - _S21 + Constants_0.reach_0 - u32(1);
    var _S22 : u32 = phase_0(position_2);
    return upsampleColumn_0(newest_1, _S22, thread_1.x);
}

fn tileRow_0( tile_4 : u32,  row_2 : u32) -> vec2<u32>
{
    return tiles_0[u32(17) * tile_4 + u32(1) + row_2];
}

fn isIn_0( columns_0 : u32,  column_2 : u32) -> bool
{
    return ((((columns_0 >> (column_2))) & (u32(1)))) != u32(0);
}

fn texelOf_0( run_0 : vec2<u32>,  column_3 : u32) -> u32
{
    return run_0.x + countOneBits(((run_0.y) & ((((u32(1) << (column_3))) - u32(1)))));
}

fn byteAt_0( word_1 : u32,  lane_1 : u32) -> i32
{
    return (i32((word_1 << ((u32(24) - u32(8) * lane_1)))) >> (u32(24)));
}

fn stored_0( _S23 : vec3<u32>,  _S24 : u32) -> f32
{
    var _S25 : u32 = _S23.x;
    var word_2 : u32 = static_offset_0[(_S24 >> (_S25))];
    var lane_2 : u32 = (_S24 & ((((u32(1) << (_S25))) - u32(1))));
    var value_0 : f32;
    if(_S25 == u32(0))
    {
        value_0 = (bitcast<f32>(((word_2 | (lane_2)))));
    }
    else
    {
        if(_S25 == u32(1))
        {
            value_0 = halfAt_0(word_2, lane_2);
        }
        else
        {
            var _S26 : f32 = f32(byteAt_0(word_2, lane_2));
            var _S27 : u32 = _S23.z;
            var _S28 : u32 = _S24 / _S23.y;
            value_0 = _S26 * (bitcast<f32>((static_offset_0[_S27 + _S28])));
        }
    }
    return value_0;
}

fn withStatic_0( values_0 : vec4<f32>,  texel_0 : u32,  first_1 : u32) -> vec4<f32>
{
    var whole_0 : vec4<f32> = vec4<f32>(vec4<i32>(i32(0)));
    var i_1 : u32 = u32(0);
    for(;;)
    {
        if(i_1 < u32(4))
        {
        }
        else
        {
            break;
        }
        var _S29 : u32 = first_1 + i_1;
        if(_S29 < (Constants_0.channels_0))
        {
            var _S30 : f32 = stored_0(Constants_0.static_offset_layout_0, _S29 * Constants_0.texel_count_0 + texel_0);
            whole_0[i_1] = values_0[i_1] + _S30;
        }
        i_1 = i_1 + u32(1);
    }
    return whole_0;
}

fn upsampleRows_0( tile_5 : u32,  thread_2 : vec2<u32>,  rows_0 : ptr<function, array<vec4<f32>, i32(3)>>,  texel_1 : ptr<function, u32>,  inReach_0 : ptr<function, bool>) -> bool
{
    loadBatch_0(tile_5, thread_2, u32(0));
    workgroupBarrier();
    var _S31 : vec4<f32> = batchAt_0(tile_5, thread_2);
    (*rows_0)[i32(0)] = _S31;
    workgroupBarrier();
    loadBatch_0(tile_5, thread_2, u32(4));
    workgroupBarrier();
    var _S32 : vec4<f32> = batchAt_0(tile_5, thread_2);
    (*rows_0)[i32(1)] = _S32;
    workgroupBarrier();
    loadBatch_0(tile_5, thread_2, u32(8));
    workgroupBarrier();
    var _S33 : vec4<f32> = batchAt_0(tile_5, thread_2);
    (*rows_0)[i32(2)] = _S33;
    workgroupBarrier();
    var run_1 : vec2<u32> = tileRow_0(tile_5, thread_2.y);
    var _S34 : u32 = run_1.y;
    var _S35 : u32 = thread_2.x;
    var isValid_0 : bool = isIn_0(_S34, _S35);
    var i_2 : u32;
    if(isValid_0)
    {
        i_2 = texelOf_0(run_1, _S35);
    }
    else
    {
        i_2 = u32(0);
    }
    (*texel_1) = i_2;
    (*inReach_0) = isIn_0((_S34 >> (u32(16))), _S35);
    if(isValid_0)
    {
        i_2 = u32(0);
        for(;;)
        {
            if(i_2 < u32(3))
            {
            }
            else
            {
                break;
            }
            var _S36 : vec4<f32> = withStatic_0((*rows_0)[i_2], (*texel_1), u32(4) * i_2);
            (*rows_0)[i_2] = _S36;
            i_2 = i_2 + u32(1);
        }
    }
    return isValid_0;
}

fn unpackHalves_0( word_3 : u32) -> vec2<f32>
{
    return vec2<f32>(halfAt_0(word_3, u32(0)), halfAt_0(word_3, u32(1)));
}

fn unpackFour_0( words_0 : vec2<u32>) -> vec4<f32>
{
    return vec4<f32>(unpackHalves_0(words_0.x), unpackHalves_0(words_0.y));
}

fn quaternionRotate_0( q_0 : vec4<f32>,  v_0 : vec3<f32>) -> vec3<f32>
{
    var _S37 : vec3<f32> = q_0.yzw;
    var t_0 : vec3<f32> = vec3<f32>(2.0f) * cross(_S37, v_0);
    return v_0 + vec3<f32>(q_0.x) * t_0 + cross(_S37, t_0);
}

fn packHalves_0( values_1 : vec2<f32>) -> u32
{
    return ((pack2x16float(vec2f((values_1.x),0.0))) | ((((pack2x16float(vec2f((values_1.y),0.0))) << (u32(16))))));
}

fn packBounded_0( values_2 : vec2<f32>) -> u32
{
    return packHalves_0(clamp(values_2, vec2<f32>(-65504.0f), vec2<f32>(65504.0f)));
}

fn writeTexel_0( texel_2 : u32,  row_3 : u32,  values_3 : vec4<f32>)
{
    texel_channels_0[row_3 * Constants_0.texel_count_0 + texel_2] = vec2<u32>(packBounded_0(values_3.xy), packBounded_0(values_3.zw));
    return;
}

fn writeRows_0( texel_3 : u32,  first_2 : u32,  rows_1 : array<vec4<f32>, i32(3)>)
{
    var i_3 : u32 = u32(0);
    for(;;)
    {
        if(i_3 < u32(3))
        {
        }
        else
        {
            break;
        }
        writeTexel_0(texel_3, first_2 + i_3, rows_1[i_3]);
        i_3 = i_3 + u32(1);
    }
    return;
}

@compute
@workgroup_size(16, 16, 1)
fn LightTexels(@builtin(workgroup_id) group_0 : vec3<u32>, @builtin(local_invocation_id) thread_3 : vec3<u32>)
{
    var batches_0 : array<vec4<f32>, i32(3)>;
    var texel_4 : u32;
    var lit_0 : bool;
    var _S38 : bool = upsampleRows_0(group_0.x, thread_3.xy, &(batches_0), &(texel_4), &(lit_0));
    if(!_S38)
    {
        return;
    }
    if(lit_0)
    {
        var _S39 : vec4<f32> = unpackFour_0(texel_channels_0[u32(3) * Constants_0.texel_count_0 + texel_4]);
        var gain_0 : f32 = halfAt_0(texel_channels_0[u32(2) * Constants_0.texel_count_0 + texel_4].y, u32(1));
        var y_0 : vec3<f32> = vec3<f32>(batches_0[i32(0)].w, batches_0[i32(1)].xy);
        var z_0 : vec3<f32> = vec3<f32>(batches_0[i32(1)].zw, batches_0[i32(2)].x);
        var x_0 : vec3<f32> = batches_0[i32(2)].yzw;
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
            var turned_0 : vec3<f32> = quaternionRotate_0(_S39, vec3<f32>(- x_0[k_0], - y_0[k_0], z_0[k_0]));
            x_0[k_0] = - turned_0.x;
            y_0[k_0] = - turned_0.y;
            z_0[k_0] = turned_0.z;
            k_0 = k_0 + u32(1);
        }
        batches_0[i32(0)] = vec4<f32>(batches_0[i32(0)].xyz + vec3<f32>(gain_0) * (batches_0[i32(0)].xyz + vec3<f32>(1.77245378494262695f)), y_0.x);
        batches_0[i32(1)] = vec4<f32>(y_0.yz, z_0.xy);
        batches_0[i32(2)] = vec4<f32>(z_0.z, x_0);
    }
    writeRows_0(texel_4, u32(3), batches_0);
    return;
}

`,
};
