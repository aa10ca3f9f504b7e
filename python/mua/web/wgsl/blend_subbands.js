// Generated from ComputeShaders/blend_subbands.compute by tools/gen_wgsl.py; do not edit.

/** @type {import("../shader.js").Shader} */
export const BlendLl = {
  ...{"stage": "comp", "entry": "BlendLl", "buffers": [{"name": "mean", "binding": 0, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "basis", "binding": 1, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "alpha", "binding": 4, "read_only": true, "scalar": "float", "stride": 4}, {"name": "blended", "binding": 5, "read_only": false, "scalar": "uint", "stride": 4}], "constants": [{"name": "mean_layout", "offset": 0, "scalar": "uint", "shape": [3], "strides": [4], "used": true}, {"name": "basis_layout", "offset": 16, "scalar": "uint", "shape": [3], "strides": [4], "used": true}, {"name": "h_layout", "offset": 32, "scalar": "uint", "shape": [3], "strides": [4], "used": false}, {"name": "w_layout", "offset": 48, "scalar": "uint", "shape": [3], "strides": [4], "used": false}, {"name": "channels", "offset": 60, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "rank", "offset": 64, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "size", "offset": 68, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "alpha_offset", "offset": 72, "scalar": "uint", "shape": [], "strides": [], "used": true}], "constants_binding": 6, "threads": [64, 1, 1]},
  code: `struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) mean_layout_0 : vec3<u32>,
    @align(16) basis_layout_0 : vec3<u32>,
    @align(16) h_layout_0 : vec3<u32>,
    @align(16) w_layout_0 : vec3<u32>,
    @align(4) channels_0 : u32,
    @align(16) rank_0 : u32,
    @align(4) size_0 : u32,
    @align(8) alpha_offset_0 : u32,
};

@binding(6) @group(0) var<uniform> Constants_0 : SLANG_ParameterGroup_Constants_std140_0;
@binding(0) @group(0) var<storage, read> mean_0 : array<u32>;

@binding(4) @group(0) var<storage, read> alpha_0 : array<f32>;

@binding(1) @group(0) var<storage, read> basis_0 : array<u32>;

@binding(5) @group(0) var<storage, read_write> blended_0 : array<u32>;

fn rowWords_0( size_1 : u32) -> u32
{
    return (size_1 + u32(1)) / u32(2);
}

fn neighbours_0( row_0 : u32,  column_0 : u32) -> vec2<u32>
{
    return vec2<u32>((row_0 * Constants_0.size_0)) + min(vec2<u32>(column_0, column_0 + u32(1)), vec2<u32>((Constants_0.size_0 - u32(1))));
}

fn halfAt_0( word_0 : u32,  lane_0 : u32) -> f32
{
    return (unpack2x16float(((((word_0 >> ((u32(16) * lane_0)))) & (u32(65535))))).x);
}

fn byteAt_0( word_1 : u32,  lane_1 : u32) -> i32
{
    return (i32((word_1 << ((u32(24) - u32(8) * lane_1)))) >> (u32(24)));
}

fn packHalves_0( values_0 : vec2<f32>) -> u32
{
    return ((pack2x16float(vec2f((values_0.x),0.0))) | ((((pack2x16float(vec2f((values_0.y),0.0))) << (u32(16))))));
}

fn packBounded_0( values_1 : vec2<f32>) -> u32
{
    return packHalves_0(clamp(values_1, vec2<f32>(-65504.0f), vec2<f32>(65504.0f)));
}

fn stored_0( _S1 : vec3<u32>,  _S2 : u32) -> f32
{
    var _S3 : u32 = _S1.x;
    var word_2 : u32 = mean_0[(_S2 >> (_S3))];
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
            value_0 = _S4 * (bitcast<f32>((mean_0[_S5 + _S6])));
        }
    }
    return value_0;
}

fn storedPair_0( _S7 : vec3<u32>,  _S8 : vec2<u32>) -> vec2<f32>
{
    var _S9 : f32 = stored_0(_S7, _S8.x);
    var _S10 : f32 = stored_0(_S7, _S8.y);
    return vec2<f32>(_S9, _S10);
}

fn stored_1( _S11 : vec3<u32>,  _S12 : u32) -> f32
{
    var _S13 : u32 = _S11.x;
    var word_3 : u32 = basis_0[(_S12 >> (_S13))];
    var lane_3 : u32 = (_S12 & ((((u32(1) << (_S13))) - u32(1))));
    var value_1 : f32;
    if(_S13 == u32(0))
    {
        value_1 = (bitcast<f32>(((word_3 | (lane_3)))));
    }
    else
    {
        if(_S13 == u32(1))
        {
            value_1 = halfAt_0(word_3, lane_3);
        }
        else
        {
            var _S14 : f32 = f32(byteAt_0(word_3, lane_3));
            var _S15 : u32 = _S11.z;
            var _S16 : u32 = _S12 / _S11.y;
            value_1 = _S14 * (bitcast<f32>((basis_0[_S15 + _S16])));
        }
    }
    return value_1;
}

fn storedPair_1( _S17 : vec3<u32>,  _S18 : vec2<u32>) -> vec2<f32>
{
    var _S19 : f32 = stored_1(_S17, _S18.x);
    var _S20 : f32 = stored_1(_S17, _S18.y);
    return vec2<f32>(_S19, _S20);
}

@compute
@workgroup_size(64, 1, 1)
fn BlendLl(@builtin(global_invocation_id) id_0 : vec3<u32>)
{
    var pairs_0 : u32 = Constants_0.size_0 * rowWords_0(Constants_0.size_0);
    var channel_0 : u32 = id_0.y;
    var _S21 : u32 = id_0.x;
    var _S22 : bool;
    if(_S21 >= pairs_0)
    {
        _S22 = true;
    }
    else
    {
        _S22 = channel_0 >= (Constants_0.channels_0);
    }
    if(_S22)
    {
        return;
    }
    var _S23 : u32 = _S21 / rowWords_0(Constants_0.size_0);
    var _S24 : u32 = _S21 % rowWords_0(Constants_0.size_0);
    var texels_0 : vec2<u32> = neighbours_0(_S23, u32(2) * _S24);
    var plane_0 : u32 = Constants_0.size_0 * Constants_0.size_0;
    var _S25 : vec2<f32> = storedPair_0(Constants_0.mean_layout_0, vec2<u32>((channel_0 * plane_0)) + texels_0);
    var r_0 : u32 = u32(0);
    var sum_0 : vec2<f32> = _S25;
    for(;;)
    {
        if(r_0 < (Constants_0.rank_0))
        {
        }
        else
        {
            break;
        }
        var map_0 : u32 = channel_0 * Constants_0.rank_0 + r_0;
        var _S26 : f32 = alpha_0[Constants_0.alpha_offset_0 + map_0];
        var _S27 : vec2<f32> = storedPair_1(Constants_0.basis_layout_0, vec2<u32>((map_0 * plane_0)) + texels_0);
        var sum_1 : vec2<f32> = sum_0 + vec2<f32>(_S26) * _S27;
        r_0 = r_0 + u32(1);
        sum_0 = sum_1;
    }
    blended_0[channel_0 * pairs_0 + _S21] = packBounded_0(sum_0);
    return;
}

`,
};

/** @type {import("../shader.js").Shader} */
export const BlendDetail = {
  ...{"stage": "comp", "entry": "BlendDetail", "buffers": [{"name": "mean", "binding": 0, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "h", "binding": 2, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "w", "binding": 3, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "alpha", "binding": 4, "read_only": true, "scalar": "float", "stride": 4}, {"name": "blended", "binding": 5, "read_only": false, "scalar": "uint", "stride": 4}], "constants": [{"name": "mean_layout", "offset": 0, "scalar": "uint", "shape": [3], "strides": [4], "used": true}, {"name": "basis_layout", "offset": 16, "scalar": "uint", "shape": [3], "strides": [4], "used": false}, {"name": "h_layout", "offset": 32, "scalar": "uint", "shape": [3], "strides": [4], "used": true}, {"name": "w_layout", "offset": 48, "scalar": "uint", "shape": [3], "strides": [4], "used": true}, {"name": "channels", "offset": 60, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "rank", "offset": 64, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "size", "offset": 68, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "alpha_offset", "offset": 72, "scalar": "uint", "shape": [], "strides": [], "used": true}], "constants_binding": 6, "threads": [12, 8, 1]},
  code: `struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) mean_layout_0 : vec3<u32>,
    @align(16) basis_layout_0 : vec3<u32>,
    @align(16) h_layout_0 : vec3<u32>,
    @align(16) w_layout_0 : vec3<u32>,
    @align(4) channels_0 : u32,
    @align(16) rank_0 : u32,
    @align(4) size_0 : u32,
    @align(8) alpha_offset_0 : u32,
};

@binding(6) @group(0) var<uniform> Constants_0 : SLANG_ParameterGroup_Constants_std140_0;
@binding(4) @group(0) var<storage, read> alpha_0 : array<f32>;

@binding(2) @group(0) var<storage, read> h_0 : array<u32>;

@binding(3) @group(0) var<storage, read> w_0 : array<u32>;

@binding(0) @group(0) var<storage, read> mean_0 : array<u32>;

@binding(5) @group(0) var<storage, read_write> blended_0 : array<u32>;

var<workgroup> tileRows_0 : array<f32, i32(384)>;

fn halfAt_0( word_0 : u32,  lane_0 : u32) -> f32
{
    return (unpack2x16float(((((word_0 >> ((u32(16) * lane_0)))) & (u32(65535))))).x);
}

fn byteAt_0( word_1 : u32,  lane_1 : u32) -> i32
{
    return (i32((word_1 << ((u32(24) - u32(8) * lane_1)))) >> (u32(24)));
}

var<workgroup> tileColumns_0 : array<f32, i32(384)>;

fn neighbours_0( row_0 : u32,  column_0 : u32) -> vec2<u32>
{
    return vec2<u32>((row_0 * Constants_0.size_0)) + min(vec2<u32>(column_0, column_0 + u32(1)), vec2<u32>((Constants_0.size_0 - u32(1))));
}

fn rowWords_0( size_1 : u32) -> u32
{
    return (size_1 + u32(1)) / u32(2);
}

fn packHalves_0( values_0 : vec2<f32>) -> u32
{
    return ((pack2x16float(vec2f((values_0.x),0.0))) | ((((pack2x16float(vec2f((values_0.y),0.0))) << (u32(16))))));
}

fn packBounded_0( values_1 : vec2<f32>) -> u32
{
    return packHalves_0(clamp(values_1, vec2<f32>(-65504.0f), vec2<f32>(65504.0f)));
}

fn stored_0( _S1 : vec3<u32>,  _S2 : u32) -> f32
{
    var _S3 : u32 = _S1.x;
    var word_2 : u32 = h_0[(_S2 >> (_S3))];
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
            value_0 = _S4 * (bitcast<f32>((h_0[_S5 + _S6])));
        }
    }
    return value_0;
}

fn factor_0( _S7 : vec3<u32>,  _S8 : u32,  _S9 : u32,  _S10 : u32) -> f32
{
    var _S11 : bool;
    if(_S9 < (Constants_0.rank_0))
    {
        _S11 = _S10 < (Constants_0.size_0);
    }
    else
    {
        _S11 = false;
    }
    var value_1 : f32;
    if(_S11)
    {
        var _S12 : f32 = stored_0(_S7, (_S8 * Constants_0.rank_0 + _S9) * Constants_0.size_0 + _S10);
        value_1 = _S12;
    }
    else
    {
        value_1 = 0.0f;
    }
    return value_1;
}

fn stored_1( _S13 : vec3<u32>,  _S14 : u32) -> f32
{
    var _S15 : u32 = _S13.x;
    var word_3 : u32 = w_0[(_S14 >> (_S15))];
    var lane_3 : u32 = (_S14 & ((((u32(1) << (_S15))) - u32(1))));
    var value_2 : f32;
    if(_S15 == u32(0))
    {
        value_2 = (bitcast<f32>(((word_3 | (lane_3)))));
    }
    else
    {
        if(_S15 == u32(1))
        {
            value_2 = halfAt_0(word_3, lane_3);
        }
        else
        {
            var _S16 : f32 = f32(byteAt_0(word_3, lane_3));
            var _S17 : u32 = _S13.z;
            var _S18 : u32 = _S14 / _S13.y;
            value_2 = _S16 * (bitcast<f32>((w_0[_S17 + _S18])));
        }
    }
    return value_2;
}

fn factor_1( _S19 : vec3<u32>,  _S20 : u32,  _S21 : u32,  _S22 : u32) -> f32
{
    var _S23 : bool;
    if(_S21 < (Constants_0.rank_0))
    {
        _S23 = _S22 < (Constants_0.size_0);
    }
    else
    {
        _S23 = false;
    }
    var value_3 : f32;
    if(_S23)
    {
        var _S24 : f32 = stored_1(_S19, (_S20 * Constants_0.rank_0 + _S21) * Constants_0.size_0 + _S22);
        value_3 = _S24;
    }
    else
    {
        value_3 = 0.0f;
    }
    return value_3;
}

fn stored_2( _S25 : vec3<u32>,  _S26 : u32) -> f32
{
    var _S27 : u32 = _S25.x;
    var word_4 : u32 = mean_0[(_S26 >> (_S27))];
    var lane_4 : u32 = (_S26 & ((((u32(1) << (_S27))) - u32(1))));
    var value_4 : f32;
    if(_S27 == u32(0))
    {
        value_4 = (bitcast<f32>(((word_4 | (lane_4)))));
    }
    else
    {
        if(_S27 == u32(1))
        {
            value_4 = halfAt_0(word_4, lane_4);
        }
        else
        {
            var _S28 : f32 = f32(byteAt_0(word_4, lane_4));
            var _S29 : u32 = _S25.z;
            var _S30 : u32 = _S26 / _S25.y;
            value_4 = _S28 * (bitcast<f32>((mean_0[_S29 + _S30])));
        }
    }
    return value_4;
}

fn storedPair_0( _S31 : vec3<u32>,  _S32 : vec2<u32>) -> vec2<f32>
{
    var _S33 : f32 = stored_2(_S31, _S32.x);
    var _S34 : f32 = stored_2(_S31, _S32.y);
    return vec2<f32>(_S33, _S34);
}

@compute
@workgroup_size(12, 8, 1)
fn BlendDetail(@builtin(workgroup_id) group_0 : vec3<u32>, @builtin(local_invocation_id) thread_0 : vec3<u32>, @builtin(local_invocation_index) slot_0 : u32)
{
    var i_0 : u32;
    var plane_0 : u32 = group_0.z;
    var _S35 : u32 = plane_0 % Constants_0.channels_0;
    var _S36 : vec2<u32> = group_0.xy * vec2<u32>(u32(24));
    var _S37 : vec2<f32> = vec2<f32>(0.0f);
    var sums_0 : array<vec2<f32>, i32(3)>;
    sums_0[i32(0)] = _S37;
    sums_0[i32(1)] = _S37;
    sums_0[i32(2)] = _S37;
    var start_0 : u32 = u32(0);
    for(;;)
    {
        if(start_0 < (Constants_0.rank_0))
        {
        }
        else
        {
            break;
        }
        i_0 = slot_0;
        for(;;)
        {
            if(i_0 < u32(384))
            {
            }
            else
            {
                break;
            }
            var r_0 : u32 = start_0 + i_0 / u32(24);
            var position_0 : u32 = i_0 % u32(24);
            var coefficient_0 : f32 = alpha_0[Constants_0.alpha_offset_0 + _S35 * Constants_0.rank_0 + min(r_0, Constants_0.rank_0 - u32(1))];
            var _S38 : f32 = factor_0(Constants_0.h_layout_0, plane_0, r_0, _S36.y + position_0);
            tileRows_0[i_0] = coefficient_0 * _S38;
            var _S39 : f32 = factor_1(Constants_0.w_layout_0, plane_0, r_0, _S36.x + position_0);
            tileColumns_0[i_0] = _S39;
            i_0 = i_0 + u32(96);
        }
        workgroupBarrier();
        var k_0 : u32 = u32(0);
        for(;;)
        {
            if(k_0 < u32(16))
            {
            }
            else
            {
                break;
            }
            var _S40 : u32 = k_0 * u32(24);
            var _S41 : u32 = _S40 + thread_0.y;
            var column_1 : u32 = _S40 + u32(2) * thread_0.x;
            var _S42 : vec2<f32> = vec2<f32>(tileColumns_0[column_1], tileColumns_0[column_1 + u32(1)]);
            var j_0 : u32 = u32(0);
            for(;;)
            {
                if(j_0 < u32(3))
                {
                }
                else
                {
                    break;
                }
                sums_0[j_0] = sums_0[j_0] + vec2<f32>(tileRows_0[_S41 + j_0 * u32(8)]) * _S42;
                j_0 = j_0 + u32(1);
            }
            k_0 = k_0 + u32(1);
        }
        workgroupBarrier();
        start_0 = start_0 + u32(16);
    }
    i_0 = u32(0);
    for(;;)
    {
        if(i_0 < u32(3))
        {
        }
        else
        {
            break;
        }
        var at_0 : vec2<u32> = _S36 + vec2<u32>(u32(2) * thread_0.x, thread_0.y + u32(8) * i_0);
        var _S43 : u32 = at_0.x;
        var _S44 : bool;
        if(_S43 < (Constants_0.size_0))
        {
            _S44 = (at_0.y) < (Constants_0.size_0);
        }
        else
        {
            _S44 = false;
        }
        if(_S44)
        {
            var row_1 : u32 = plane_0 * Constants_0.size_0 + at_0.y;
            var _S45 : vec2<f32> = storedPair_0(Constants_0.mean_layout_0, neighbours_0(row_1, _S43));
            blended_0[row_1 * rowWords_0(Constants_0.size_0) + _S43 / u32(2)] = packBounded_0(_S45 + sums_0[i_0]);
        }
        i_0 = i_0 + u32(1);
    }
    return;
}

`,
};
