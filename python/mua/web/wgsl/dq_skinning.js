// Generated from ComputeShaders/dq_skinning.compute by tools/gen_wgsl.py; do not edit.

/** @type {import("../shader.js").Shader} */
export const BlendVertices = {
  ...{"stage": "comp", "entry": "BlendVertices", "buffers": [{"name": "joints", "binding": 0, "read_only": true, "scalar": "float", "stride": 16}, {"name": "indices", "binding": 1, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "weights", "binding": 2, "read_only": true, "scalar": "float", "stride": 4}, {"name": "vertex_dq", "binding": 3, "read_only": false, "scalar": "float", "stride": 16}], "constants": [{"name": "vertex_count", "offset": 0, "scalar": "uint", "shape": [], "strides": [], "used": true}], "constants_binding": 4, "threads": [64, 1, 1]},
  code: `struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) vertex_count_0 : u32,
};

@binding(4) @group(0) var<uniform> Constants_0 : SLANG_ParameterGroup_Constants_std140_0;
@binding(1) @group(0) var<storage, read> indices_0 : array<u32>;

@binding(0) @group(0) var<storage, read> joints_0 : array<vec4<f32>>;

@binding(2) @group(0) var<storage, read> weights_0 : array<f32>;

@binding(3) @group(0) var<storage, read_write> vertex_dq_0 : array<vec4<f32>>;

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

@compute
@workgroup_size(64, 1, 1)
fn BlendVertices(@builtin(global_invocation_id) thread_0 : vec3<u32>)
{
    var vertex_0 : u32 = thread_0.x;
    if(vertex_0 >= (Constants_0.vertex_count_0))
    {
        return;
    }
    var _S5 : u32 = u32(8) * vertex_0;
    var _S6 : vec4<f32> = joints_0[u32(2) * indices_0[_S5]];
    var total_2 : DualQuaternion_0 = noTransform_0();
    var i_0 : u32 = _S5;
    for(;;)
    {
        if(i_0 < (u32(8) * (vertex_0 + u32(1))))
        {
        }
        else
        {
            break;
        }
        var _S7 : DualQuaternion_0 = accumulate_0(total_2, joints_0[u32(2) * indices_0[i_0]], joints_0[u32(2) * indices_0[i_0] + u32(1)], weights_0[i_0], _S6);
        var _S8 : u32 = i_0 + u32(1);
        total_2 = _S7;
        i_0 = _S8;
    }
    var total_3 : DualQuaternion_0 = normalized_0(total_2);
    var _S9 : u32 = u32(2) * vertex_0;
    vertex_dq_0[_S9] = total_3.real_0;
    vertex_dq_0[_S9 + u32(1)] = total_3.dual_0;
    return;
}

`,
};
