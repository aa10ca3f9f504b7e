// Generated from ComputeShaders/expressions.compute by tools/gen_wgsl.py; do not edit.

/** @type {import("../shader.js").Shader} */
export const SumTargets = {
  ...{"stage": "comp", "entry": "SumTargets", "buffers": [{"name": "vertices", "binding": 0, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "starts", "binding": 1, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "expressions", "binding": 2, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "changes", "binding": 3, "read_only": true, "scalar": "float", "stride": 16}, {"name": "weights", "binding": 4, "read_only": true, "scalar": "float", "stride": 4}, {"name": "moved", "binding": 9, "read_only": false, "scalar": "float", "stride": 16}, {"name": "mesh", "binding": 10, "read_only": false, "scalar": "float", "stride": 4}], "constants": [{"name": "vertex_count", "offset": 0, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "triangle_count", "offset": 4, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "texel_count", "offset": 8, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "splat_count", "offset": 12, "scalar": "uint", "shape": [], "strides": [], "used": false}], "constants_binding": 14, "threads": [64, 1, 1]},
  code: `struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) vertex_count_0 : u32,
    @align(4) triangle_count_0 : u32,
    @align(8) texel_count_0 : u32,
    @align(4) splat_count_0 : u32,
};

@binding(14) @group(0) var<uniform> Constants_0 : SLANG_ParameterGroup_Constants_std140_0;
@binding(1) @group(0) var<storage, read> starts_0 : array<u32>;

@binding(2) @group(0) var<storage, read> expressions_0 : array<u32>;

@binding(4) @group(0) var<storage, read> weights_0 : array<f32>;

@binding(3) @group(0) var<storage, read> changes_0 : array<vec4<f32>>;

@binding(0) @group(0) var<storage, read> vertices_0 : array<u32>;

@binding(9) @group(0) var<storage, read_write> moved_0 : array<vec4<f32>>;

@binding(10) @group(0) var<storage, read_write> mesh_0 : array<f32>;

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
        var sum_1 : vec4<f32> = sum_0 + vec4<f32>(weights_0[expressions_0[i_0]]) * changes_0[i_0];
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
  ...{"stage": "comp", "entry": "BendTriangles", "buffers": [{"name": "vertices", "binding": 0, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "corners", "binding": 5, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "moved", "binding": 9, "read_only": false, "scalar": "float", "stride": 16}, {"name": "mesh", "binding": 10, "read_only": false, "scalar": "float", "stride": 4}, {"name": "triangle_bends", "binding": 11, "read_only": false, "scalar": "float", "stride": 16}], "constants": [{"name": "vertex_count", "offset": 0, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "triangle_count", "offset": 4, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "texel_count", "offset": 8, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "splat_count", "offset": 12, "scalar": "uint", "shape": [], "strides": [], "used": false}], "constants_binding": 14, "threads": [64, 1, 1]},
  code: `struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) vertex_count_0 : u32,
    @align(4) triangle_count_0 : u32,
    @align(8) texel_count_0 : u32,
    @align(4) splat_count_0 : u32,
};

@binding(14) @group(0) var<uniform> Constants_0 : SLANG_ParameterGroup_Constants_std140_0;
@binding(5) @group(0) var<storage, read> corners_0 : array<u32>;

@binding(0) @group(0) var<storage, read> vertices_0 : array<u32>;

@binding(9) @group(0) var<storage, read_write> moved_0 : array<vec4<f32>>;

@binding(10) @group(0) var<storage, read_write> mesh_0 : array<f32>;

@binding(11) @group(0) var<storage, read_write> triangle_bends_0 : array<vec4<f32>>;

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
};

fn noBend_0() -> Bend_0
{
    var bend_0 : Bend_0;
    bend_0.turn_0 = vec4<f32>(1.0f, 0.0f, 0.0f, 0.0f);
    bend_0.diagonal_0 = vec3<f32>(vec3<i32>(i32(1)));
    bend_0.others_0 = vec3<f32>(vec3<i32>(i32(0)));
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
    return bend_1;
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
        var vertex_1 : u32 = vertices_0[corners_0[u32(3) * _S42 + i_1]];
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
    var _S45 : u32 = u32(3) * _S42;
    triangle_bends_0[_S45] = vec4<f32>(area_0) * bend_2.turn_0;
    triangle_bends_0[_S45 + u32(1)] = vec4<f32>(area_0) * vec4<f32>(bend_2.diagonal_0, bend_2.others_0.x);
    var _S46 : vec3<f32> = vec3<f32>(area_0) * vec3<f32>(bend_2.others_0.yz, 1.0f);
    var _S47 : i32;
    if(moves_0)
    {
        _S47 = i32(1);
    }
    else
    {
        _S47 = i32(0);
    }
    triangle_bends_0[_S45 + u32(2)] = vec4<f32>(_S46, f32(_S47));
    return;
}

`,
};

/** @type {import("../shader.js").Shader} */
export const BendVertices = {
  ...{"stage": "comp", "entry": "BendVertices", "buffers": [{"name": "starts", "binding": 1, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "stars", "binding": 6, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "triangle_bends", "binding": 11, "read_only": false, "scalar": "float", "stride": 16}, {"name": "vertex_bends", "binding": 12, "read_only": false, "scalar": "float", "stride": 16}], "constants": [{"name": "vertex_count", "offset": 0, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "triangle_count", "offset": 4, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "texel_count", "offset": 8, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "splat_count", "offset": 12, "scalar": "uint", "shape": [], "strides": [], "used": false}], "constants_binding": 14, "threads": [64, 1, 1]},
  code: `struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) vertex_count_0 : u32,
    @align(4) triangle_count_0 : u32,
    @align(8) texel_count_0 : u32,
    @align(4) splat_count_0 : u32,
};

@binding(14) @group(0) var<uniform> Constants_0 : SLANG_ParameterGroup_Constants_std140_0;
@binding(1) @group(0) var<storage, read> starts_0 : array<u32>;

@binding(6) @group(0) var<storage, read> stars_0 : array<u32>;

@binding(11) @group(0) var<storage, read_write> triangle_bends_0 : array<vec4<f32>>;

@binding(12) @group(0) var<storage, read_write> vertex_bends_0 : array<vec4<f32>>;

fn addTurn_0( sum_0 : vec4<f32>,  turn_0 : vec4<f32>) -> vec4<f32>
{
    var _S1 : i32;
    if((dot(sum_0, turn_0)) < 0.0f)
    {
        _S1 = i32(-1);
    }
    else
    {
        _S1 = i32(1);
    }
    return sum_0 + vec4<f32>(f32(_S1)) * turn_0;
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
    var _S3 : vec4<f32> = vec4<f32>(vec4<i32>(i32(0)));
    var _S4 : u32 = starts_0[_S2];
    var turn_1 : vec4<f32> = _S3;
    var i_0 : u32 = _S4;
    var first_0 : vec4<f32> = _S3;
    var last_0 : vec4<f32> = _S3;
    for(;;)
    {
        if(i_0 < starts_0[_S2 + u32(1)])
        {
        }
        else
        {
            break;
        }
        var bend_0 : u32 = u32(3) * stars_0[i_0];
        var _S5 : vec4<f32> = addTurn_0(turn_1, triangle_bends_0[bend_0]);
        var first_1 : vec4<f32> = first_0 + triangle_bends_0[bend_0 + u32(1)];
        var last_1 : vec4<f32> = last_0 + triangle_bends_0[bend_0 + u32(2)];
        var _S6 : u32 = i_0 + u32(1);
        turn_1 = _S5;
        i_0 = _S6;
        first_0 = first_1;
        last_0 = last_1;
    }
    if((last_0.w) == 0.0f)
    {
        const _S7 : vec4<f32> = vec4<f32>(1.0f, 1.0f, 1.0f, 0.0f);
        const _S8 : vec4<f32> = vec4<f32>(0.0f, 0.0f, 1.0f, 0.0f);
        turn_1 = vec4<f32>(1.0f, 0.0f, 0.0f, 0.0f);
        last_0 = _S8;
        first_0 = _S7;
    }
    var _S9 : f32 = last_0.z;
    var _S10 : bool = _S9 > 0.0f;
    var share_0 : f32;
    if(_S10)
    {
        share_0 = 1.0f / _S9;
    }
    else
    {
        share_0 = 0.0f;
    }
    var _S11 : u32 = u32(3) * _S2;
    vertex_bends_0[_S11] = vec4<f32>(share_0) * turn_1;
    vertex_bends_0[_S11 + u32(1)] = vec4<f32>(share_0) * first_0;
    var _S12 : vec2<f32> = vec2<f32>(share_0) * last_0.xy;
    var _S13 : i32;
    if(_S10)
    {
        _S13 = i32(1);
    }
    else
    {
        _S13 = i32(0);
    }
    var _S14 : f32 = f32(_S13);
    if((last_0.w) > 0.0f)
    {
        _S13 = i32(1);
    }
    else
    {
        _S13 = i32(0);
    }
    vertex_bends_0[_S11 + u32(2)] = vec4<f32>(_S12, _S14, f32(_S13));
    return;
}

`,
};

/** @type {import("../shader.js").Shader} */
export const BendTexels = {
  ...{"stage": "comp", "entry": "BendTexels", "buffers": [{"name": "vertices", "binding": 0, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "corners", "binding": 5, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "reached", "binding": 7, "read_only": true, "scalar": "uint", "stride": 8}, {"name": "texels", "binding": 8, "read_only": true, "scalar": "uint", "stride": 8}, {"name": "moved", "binding": 9, "read_only": false, "scalar": "float", "stride": 16}, {"name": "vertex_bends", "binding": 12, "read_only": false, "scalar": "float", "stride": 16}, {"name": "texel_channels", "binding": 13, "read_only": false, "scalar": "uint", "stride": 8}], "constants": [{"name": "vertex_count", "offset": 0, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "triangle_count", "offset": 4, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "texel_count", "offset": 8, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "splat_count", "offset": 12, "scalar": "uint", "shape": [], "strides": [], "used": true}], "constants_binding": 14, "threads": [64, 1, 1]},
  code: `struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) vertex_count_0 : u32,
    @align(4) triangle_count_0 : u32,
    @align(8) texel_count_0 : u32,
    @align(4) splat_count_0 : u32,
};

@binding(14) @group(0) var<uniform> Constants_0 : SLANG_ParameterGroup_Constants_std140_0;
@binding(7) @group(0) var<storage, read> reached_0 : array<vec2<u32>>;

@binding(8) @group(0) var<storage, read> texels_0 : array<vec2<u32>>;

@binding(5) @group(0) var<storage, read> corners_0 : array<u32>;

@binding(12) @group(0) var<storage, read_write> vertex_bends_0 : array<vec4<f32>>;

@binding(0) @group(0) var<storage, read> vertices_0 : array<u32>;

@binding(9) @group(0) var<storage, read_write> moved_0 : array<vec4<f32>>;

@binding(13) @group(0) var<storage, read_write> texel_channels_0 : array<vec2<u32>>;

fn addTurn_0( sum_0 : vec4<f32>,  turn_0 : vec4<f32>) -> vec4<f32>
{
    var _S1 : i32;
    if((dot(sum_0, turn_0)) < 0.0f)
    {
        _S1 = i32(-1);
    }
    else
    {
        _S1 = i32(1);
    }
    return sum_0 + vec4<f32>(f32(_S1)) * turn_0;
}

fn halfAt_0( word_0 : u32,  lane_0 : u32) -> f32
{
    return (unpack2x16float(((((word_0 >> ((u32(16) * lane_0)))) & (u32(65535))))).x);
}

fn unpackHalves_0( word_1 : u32) -> vec2<f32>
{
    return vec2<f32>(halfAt_0(word_1, u32(0)), halfAt_0(word_1, u32(1)));
}

fn packHalves_0( values_0 : vec2<f32>) -> u32
{
    return ((pack2x16float(vec2f((values_0.x),0.0))) | ((((pack2x16float(vec2f((values_0.y),0.0))) << (u32(16))))));
}

fn packBounded_0( values_1 : vec2<f32>) -> u32
{
    return packHalves_0(clamp(values_1, vec2<f32>(-65504.0f), vec2<f32>(65504.0f)));
}

fn brighten_0( texel_0 : u32,  gain_0 : f32)
{
    var _S2 : u32 = texel_channels_0[u32(3) * Constants_0.splat_count_0 + texel_0].y;
    var color_0 : vec3<f32> = vec3<f32>(unpackHalves_0(texel_channels_0[u32(3) * Constants_0.splat_count_0 + texel_0].x), halfAt_0(_S2, u32(0)));
    var color_1 : vec3<f32> = color_0 + vec3<f32>(gain_0) * (color_0 + vec3<f32>(1.77245378494262695f));
    texel_channels_0[u32(3) * Constants_0.splat_count_0 + texel_0] = vec2<u32>(packBounded_0(color_1.xy), (((_S2 & (u32(4294901760)))) | ((packBounded_0(vec2<f32>(color_1.z, 0.0f))))));
    return;
}

fn quaternionRotate_0( q_0 : vec4<f32>,  v_0 : vec3<f32>) -> vec3<f32>
{
    var _S3 : vec3<f32> = q_0.yzw;
    var t_0 : vec3<f32> = vec3<f32>(2.0f) * cross(_S3, v_0);
    return v_0 + vec3<f32>(q_0.x) * t_0 + cross(_S3, t_0);
}

fn turnColors_0( texel_1 : u32,  turn_1 : vec4<f32>)
{
    var _S4 : vec2<u32> = texel_channels_0[u32(3) * Constants_0.splat_count_0 + texel_1];
    var _S5 : u32 = texel_channels_0[u32(3) * Constants_0.splat_count_0 + texel_1].y;
    var y_0 : vec3<f32> = vec3<f32>(halfAt_0(_S5, u32(1)), unpackHalves_0(texel_channels_0[u32(4) * Constants_0.splat_count_0 + texel_1].x));
    var _S6 : u32 = texel_channels_0[u32(5) * Constants_0.splat_count_0 + texel_1].x;
    var z_0 : vec3<f32> = vec3<f32>(unpackHalves_0(texel_channels_0[u32(4) * Constants_0.splat_count_0 + texel_1].y), halfAt_0(_S6, u32(0)));
    var x_0 : vec3<f32> = vec3<f32>(halfAt_0(_S6, u32(1)), unpackHalves_0(texel_channels_0[u32(5) * Constants_0.splat_count_0 + texel_1].y));
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
        var turned_0 : vec3<f32> = quaternionRotate_0(turn_1, vec3<f32>(- x_0[k_0], - y_0[k_0], z_0[k_0]));
        x_0[k_0] = - turned_0.x;
        y_0[k_0] = - turned_0.y;
        z_0[k_0] = turned_0.z;
        k_0 = k_0 + u32(1);
    }
    texel_channels_0[u32(3) * Constants_0.splat_count_0 + texel_1] = vec2<u32>(_S4.x, (((_S5 & (u32(65535)))) | ((packBounded_0(vec2<f32>(0.0f, y_0.x))))));
    texel_channels_0[u32(4) * Constants_0.splat_count_0 + texel_1] = vec2<u32>(packBounded_0(y_0.yz), packBounded_0(z_0.xy));
    texel_channels_0[u32(5) * Constants_0.splat_count_0 + texel_1] = vec2<u32>(packBounded_0(vec2<f32>(z_0.z, x_0.x)), packBounded_0(x_0.yz));
    return;
}

fn quaternionMultiply_0( a_0 : vec4<f32>,  b_0 : vec4<f32>) -> vec4<f32>
{
    var _S7 : f32 = a_0.x;
    var _S8 : f32 = b_0.x;
    var _S9 : vec3<f32> = a_0.yzw;
    var _S10 : vec3<f32> = b_0.yzw;
    return vec4<f32>(_S7 * _S8 - dot(_S9, _S10), vec3<f32>(_S7) * _S10 + vec3<f32>(_S8) * _S9 + cross(_S9, _S10));
}

@compute
@workgroup_size(64, 1, 1)
fn BendTexels(@builtin(global_invocation_id) thread_0 : vec3<u32>)
{
    var _S11 : u32 = thread_0.x;
    if(_S11 >= (Constants_0.texel_count_0))
    {
        return;
    }
    var texel_2 : u32 = reached_0[_S11].x;
    var _S12 : u32 = u32(3) * reached_0[_S11].y;
    var both_0 : u32 = texels_0[texel_2].y;
    var shares_0 : vec2<f32> = vec2<f32>(f32((both_0 & (u32(65535)))), f32((both_0 >> (u32(16))))) / vec2<f32>(65535.0f);
    var _S13 : vec3<f32> = vec3<f32>(shares_0, max(1.0f - shares_0.x - shares_0.y, 0.0f));
    var _S14 : vec4<f32> = vec4<f32>(vec4<i32>(i32(0)));
    var i_0 : u32 = u32(0);
    var turn_2 : vec4<f32> = _S14;
    var first_0 : vec4<f32> = _S14;
    var last_0 : vec4<f32> = _S14;
    var gain_1 : f32 = 0.0f;
    for(;;)
    {
        if(i_0 < u32(3))
        {
        }
        else
        {
            break;
        }
        var place_0 : u32 = corners_0[_S12 + i_0];
        var bend_0 : u32 = u32(3) * place_0;
        var _S15 : vec4<f32> = vec4<f32>(_S13[i_0]);
        var _S16 : vec4<f32> = addTurn_0(turn_2, _S15 * vertex_bends_0[bend_0]);
        var first_1 : vec4<f32> = first_0 + _S15 * vertex_bends_0[bend_0 + u32(1)];
        var last_1 : vec4<f32> = last_0 + _S15 * vertex_bends_0[bend_0 + u32(2)];
        var gain_2 : f32 = gain_1 + _S13[i_0] * moved_0[vertices_0[place_0]].w;
        i_0 = i_0 + u32(1);
        turn_2 = _S16;
        first_0 = first_1;
        last_0 = last_1;
        gain_1 = gain_2;
    }
    if(gain_1 != 0.0f)
    {
        brighten_0(texel_2, gain_1);
    }
    var _S17 : f32 = last_0.z;
    var _S18 : bool;
    if(_S17 == 0.0f)
    {
        _S18 = true;
    }
    else
    {
        _S18 = (last_0.w) == 0.0f;
    }
    if(_S18)
    {
        return;
    }
    var _S19 : vec2<u32> = texel_channels_0[u32(2) * Constants_0.splat_count_0 + texel_2];
    var _S20 : u32 = texel_channels_0[texel_2].y;
    var offset_0 : vec3<f32> = vec3<f32>(unpackHalves_0(texel_channels_0[texel_2].x), halfAt_0(_S20, u32(0)));
    var _S21 : u32 = texel_channels_0[Constants_0.splat_count_0 + texel_2].y;
    var rotation_0 : vec4<f32> = vec4<f32>(halfAt_0(_S20, u32(1)), unpackHalves_0(texel_channels_0[Constants_0.splat_count_0 + texel_2].x), halfAt_0(_S21, u32(0)));
    var scale_0 : vec3<f32> = vec3<f32>(halfAt_0(_S21, u32(1)), unpackHalves_0(texel_channels_0[u32(2) * Constants_0.splat_count_0 + texel_2].x));
    var turn_3 : vec4<f32> = turn_2 / vec4<f32>(max(length(turn_2), 1.17549435082228751e-38f));
    var unit_0 : vec4<f32> = rotation_0 / vec4<f32>(max(length(rotation_0), 1.17549435082228751e-38f));
    var _S22 : f32 = first_0.w;
    var _S23 : vec3<f32> = vec3<f32>(first_0.x, _S22, last_0.x);
    var _S24 : vec3<f32> = vec3<f32>(_S22, first_0.y, last_0.y);
    var _S25 : vec3<f32> = vec3<f32>(last_0.xy, first_0.z);
    const _S26 : vec3<f32> = vec3<f32>(0.0f, 0.0f, 1.0f);
    var ends_0 : array<vec3<f32>, i32(3)> = array<vec3<f32>, i32(3)>( vec3<f32>(1.0f, 0.0f, 0.0f), vec3<f32>(0.0f, 1.0f, 0.0f), _S26 );
    var k_1 : u32 = u32(0);
    for(;;)
    {
        if(k_1 < u32(3))
        {
        }
        else
        {
            break;
        }
        var axis_0 : vec3<f32> = quaternionRotate_0(unit_0, ends_0[k_1]);
        scale_0[k_1] = scale_0[k_1] + log(clamp(length(vec3<f32>(axis_0.x) * _S23 + vec3<f32>(axis_0.y) * _S24 + vec3<f32>(axis_0.z) * _S25) / _S17, 0.05000000074505806f, 20.0f));
        k_1 = k_1 + u32(1);
    }
    var normal_0 : vec3<f32> = quaternionRotate_0(unit_0, _S26);
    var turned_1 : vec3<f32> = quaternionRotate_0(turn_3, normal_0);
    turnColors_0(texel_2, vec4<f32>(dot(normal_0, turned_1), cross(normal_0, turned_1)));
    var offset_1 : vec3<f32> = quaternionRotate_0(turn_3, offset_0);
    var rotation_1 : vec4<f32> = quaternionMultiply_0(turn_3, rotation_0);
    texel_channels_0[texel_2] = vec2<u32>(packBounded_0(offset_1.xy), packBounded_0(vec2<f32>(offset_1.z, rotation_1.x)));
    texel_channels_0[Constants_0.splat_count_0 + texel_2] = vec2<u32>(packBounded_0(rotation_1.yz), packBounded_0(vec2<f32>(rotation_1.w, scale_0.x)));
    texel_channels_0[u32(2) * Constants_0.splat_count_0 + texel_2] = vec2<u32>(packBounded_0(scale_0.yz), _S19.y);
    return;
}

`,
};
