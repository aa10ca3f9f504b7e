// Generated from ComputeShaders/mlp_matmul.compute by tools/gen_wgsl.py; do not edit.

/** @type {import("../shader.js").Shader} */
export const MlpMatmul = {
  ...{"stage": "comp", "entry": "MlpMatmul", "buffers": [{"name": "weight", "binding": 0, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "bias", "binding": 1, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "x", "binding": 2, "read_only": true, "scalar": "float", "stride": 4}, {"name": "y", "binding": 3, "read_only": false, "scalar": "float", "stride": 4}], "constants": [{"name": "weight_layout", "offset": 0, "scalar": "uint", "shape": [3], "strides": [4], "used": true}, {"name": "bias_layout", "offset": 16, "scalar": "uint", "shape": [3], "strides": [4], "used": true}, {"name": "inputs", "offset": 28, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "outputs", "offset": 32, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "relu", "offset": 36, "scalar": "uint", "shape": [], "strides": [], "used": true}], "constants_binding": 4, "threads": [32, 8, 1]},
  code: `struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) weight_layout_0 : vec3<u32>,
    @align(16) bias_layout_0 : vec3<u32>,
    @align(4) inputs_0 : u32,
    @align(16) outputs_0 : u32,
    @align(4) relu_0 : u32,
};

@binding(4) @group(0) var<uniform> Constants_0 : SLANG_ParameterGroup_Constants_std140_0;
@binding(0) @group(0) var<storage, read> weight_0 : array<u32>;

@binding(2) @group(0) var<storage, read> x_0 : array<f32>;

@binding(1) @group(0) var<storage, read> bias_0 : array<u32>;

@binding(3) @group(0) var<storage, read_write> y_0 : array<f32>;

fn halfAt_0( word_0 : u32,  lane_0 : u32) -> f32
{
    return (unpack2x16float(((((word_0 >> ((u32(16) * lane_0)))) & (u32(65535))))).x);
}

fn byteAt_0( word_1 : u32,  lane_1 : u32) -> i32
{
    return (i32((word_1 << ((u32(24) - u32(8) * lane_1)))) >> (u32(24)));
}

var<workgroup> partialSums_0 : array<f32, i32(256)>;

fn stored_0( _S1 : vec3<u32>,  _S2 : u32) -> f32
{
    var _S3 : u32 = _S1.x;
    var word_2 : u32 = weight_0[(_S2 >> (_S3))];
    var lane_2 : u32 = (_S2 & ((((u32(1) << (_S3))) - u32(1))));
    var value_0 : f32;
    if(_S3 == u32(0))
    {
        value_0 = (bitcast<f32>(((word_2 | (lane_2)))));
    }
    else
    {
        if(_S3 == u32(1))
        {
            value_0 = halfAt_0(word_2, lane_2);
        }
        else
        {
            var _S4 : f32 = f32(byteAt_0(word_2, lane_2));
            var _S5 : u32 = _S1.z;
            var _S6 : u32 = _S2 / _S1.y;
            value_0 = _S4 * (bitcast<f32>((weight_0[_S5 + _S6])));
        }
    }
    return value_0;
}

fn stored_1( _S7 : vec3<u32>,  _S8 : u32) -> f32
{
    var _S9 : u32 = _S7.x;
    var word_3 : u32 = bias_0[(_S8 >> (_S9))];
    var lane_3 : u32 = (_S8 & ((((u32(1) << (_S9))) - u32(1))));
    var value_1 : f32;
    if(_S9 == u32(0))
    {
        value_1 = (bitcast<f32>(((word_3 | (lane_3)))));
    }
    else
    {
        if(_S9 == u32(1))
        {
            value_1 = halfAt_0(word_3, lane_3);
        }
        else
        {
            var _S10 : f32 = f32(byteAt_0(word_3, lane_3));
            var _S11 : u32 = _S7.z;
            var _S12 : u32 = _S8 / _S7.y;
            value_1 = _S10 * (bitcast<f32>((bias_0[_S11 + _S12])));
        }
    }
    return value_1;
}

@compute
@workgroup_size(32, 8, 1)
fn MlpMatmul(@builtin(workgroup_id) group_0 : vec3<u32>, @builtin(local_invocation_id) thread_0 : vec3<u32>, @builtin(local_invocation_index) slot_0 : u32)
{
    var _S13 : bool;
    var lane_4 : u32 = thread_0.x;
    var row_0 : u32 = group_0.x * u32(8) + thread_0.y;
    var live_0 : bool = row_0 < (Constants_0.outputs_0);
    var column_0 : u32 = lane_4;
    var sum_0 : f32 = 0.0f;
    for(;;)
    {
        if(live_0)
        {
            _S13 = column_0 < (Constants_0.inputs_0);
        }
        else
        {
            _S13 = false;
        }
        if(_S13)
        {
        }
        else
        {
            break;
        }
        var _S14 : f32 = stored_0(Constants_0.weight_layout_0, row_0 * Constants_0.inputs_0 + column_0);
        var sum_1 : f32 = sum_0 + _S14 * x_0[column_0];
        column_0 = column_0 + u32(32);
        sum_0 = sum_1;
    }
    partialSums_0[slot_0] = sum_0;
    workgroupBarrier();
    var reach_0 : u32 = u32(16);
    for(;;)
    {
        if(reach_0 > u32(0))
        {
        }
        else
        {
            break;
        }
        if(lane_4 < reach_0)
        {
            partialSums_0[slot_0] = partialSums_0[slot_0] + partialSums_0[slot_0 + reach_0];
        }
        workgroupBarrier();
        reach_0 = reach_0 / u32(2);
    }
    if(live_0)
    {
        _S13 = lane_4 == u32(0);
    }
    else
    {
        _S13 = false;
    }
    if(_S13)
    {
        var _S15 : f32 = partialSums_0[slot_0];
        var _S16 : f32 = stored_1(Constants_0.bias_layout_0, row_0);
        var value_2 : f32 = _S15 + _S16;
        if((Constants_0.relu_0) != u32(0))
        {
            sum_0 = max(value_2, 0.0f);
        }
        else
        {
            sum_0 = value_2;
        }
        y_0[row_0] = sum_0;
    }
    return;
}

`,
};

/** @type {import("../shader.js").Shader} */
export const MlpMatmulTransposed = {
  ...{"stage": "comp", "entry": "MlpMatmulTransposed", "buffers": [{"name": "weight", "binding": 0, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "bias", "binding": 1, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "x", "binding": 2, "read_only": true, "scalar": "float", "stride": 4}, {"name": "y", "binding": 3, "read_only": false, "scalar": "float", "stride": 4}], "constants": [{"name": "weight_layout", "offset": 0, "scalar": "uint", "shape": [3], "strides": [4], "used": true}, {"name": "bias_layout", "offset": 16, "scalar": "uint", "shape": [3], "strides": [4], "used": true}, {"name": "inputs", "offset": 28, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "outputs", "offset": 32, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "relu", "offset": 36, "scalar": "uint", "shape": [], "strides": [], "used": false}], "constants_binding": 4, "threads": [64, 1, 1]},
  code: `struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) weight_layout_0 : vec3<u32>,
    @align(16) bias_layout_0 : vec3<u32>,
    @align(4) inputs_0 : u32,
    @align(16) outputs_0 : u32,
    @align(4) relu_0 : u32,
};

@binding(4) @group(0) var<uniform> Constants_0 : SLANG_ParameterGroup_Constants_std140_0;
@binding(0) @group(0) var<storage, read> weight_0 : array<u32>;

@binding(2) @group(0) var<storage, read> x_0 : array<f32>;

@binding(3) @group(0) var<storage, read_write> y_0 : array<f32>;

@binding(1) @group(0) var<storage, read> bias_0 : array<u32>;

fn halfAt_0( word_0 : u32,  lane_0 : u32) -> f32
{
    return (unpack2x16float(((((word_0 >> ((u32(16) * lane_0)))) & (u32(65535))))).x);
}

fn byteAt_0( word_1 : u32,  lane_1 : u32) -> i32
{
    return (i32((word_1 << ((u32(24) - u32(8) * lane_1)))) >> (u32(24)));
}

fn stored_0( _S1 : vec3<u32>,  _S2 : u32) -> f32
{
    var _S3 : u32 = _S1.x;
    var word_2 : u32 = weight_0[(_S2 >> (_S3))];
    var lane_2 : u32 = (_S2 & ((((u32(1) << (_S3))) - u32(1))));
    var value_0 : f32;
    if(_S3 == u32(0))
    {
        value_0 = (bitcast<f32>(((word_2 | (lane_2)))));
    }
    else
    {
        if(_S3 == u32(1))
        {
            value_0 = halfAt_0(word_2, lane_2);
        }
        else
        {
            var _S4 : f32 = f32(byteAt_0(word_2, lane_2));
            var _S5 : u32 = _S1.z;
            var _S6 : u32 = _S2 / _S1.y;
            value_0 = _S4 * (bitcast<f32>((weight_0[_S5 + _S6])));
        }
    }
    return value_0;
}

fn stored_1( _S7 : vec3<u32>,  _S8 : u32) -> f32
{
    var _S9 : u32 = _S7.x;
    var word_3 : u32 = bias_0[(_S8 >> (_S9))];
    var lane_3 : u32 = (_S8 & ((((u32(1) << (_S9))) - u32(1))));
    var value_1 : f32;
    if(_S9 == u32(0))
    {
        value_1 = (bitcast<f32>(((word_3 | (lane_3)))));
    }
    else
    {
        if(_S9 == u32(1))
        {
            value_1 = halfAt_0(word_3, lane_3);
        }
        else
        {
            var _S10 : f32 = f32(byteAt_0(word_3, lane_3));
            var _S11 : u32 = _S7.z;
            var _S12 : u32 = _S8 / _S7.y;
            value_1 = _S10 * (bitcast<f32>((bias_0[_S11 + _S12])));
        }
    }
    return value_1;
}

@compute
@workgroup_size(64, 1, 1)
fn MlpMatmulTransposed(@builtin(global_invocation_id) id_0 : vec3<u32>)
{
    var column_0 : u32 = id_0.x;
    if(column_0 >= (Constants_0.outputs_0))
    {
        return;
    }
    var row_0 : u32 = u32(0);
    var sum_0 : f32 = 0.0f;
    for(;;)
    {
        if(row_0 < (Constants_0.inputs_0))
        {
        }
        else
        {
            break;
        }
        var _S13 : f32 = stored_0(Constants_0.weight_layout_0, row_0 * Constants_0.outputs_0 + column_0);
        var sum_1 : f32 = sum_0 + _S13 * x_0[row_0];
        row_0 = row_0 + u32(1);
        sum_0 = sum_1;
    }
    var _S14 : f32 = stored_1(Constants_0.bias_layout_0, column_0);
    y_0[column_0] = sum_0 + _S14;
    return;
}

`,
};
