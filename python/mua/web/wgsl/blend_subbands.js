// Generated from ComputeShaders/blend_subbands.compute by tools/gen_wgsl.py; do not edit.

/** @type {import("../shader.js").Shader} */
export const BlendLl = {
  ...{"stage": "comp", "entry": "BlendLl", "buffers": [{"name": "mean", "binding": 0, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "basis", "binding": 1, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "alpha", "binding": 4, "read_only": true, "scalar": "float", "stride": 4}, {"name": "blended", "binding": 5, "read_only": false, "scalar": "float", "stride": 4}], "constants": [{"name": "mean_layout", "offset": 0, "scalar": "uint", "shape": [3], "strides": [4], "used": true}, {"name": "basis_layout", "offset": 16, "scalar": "uint", "shape": [3], "strides": [4], "used": true}, {"name": "h_layout", "offset": 32, "scalar": "uint", "shape": [3], "strides": [4], "used": false}, {"name": "w_layout", "offset": 48, "scalar": "uint", "shape": [3], "strides": [4], "used": false}, {"name": "channels", "offset": 60, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "rank", "offset": 64, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "size", "offset": 68, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "alpha_offset", "offset": 72, "scalar": "uint", "shape": [], "strides": [], "used": true}], "constants_binding": 6, "threads": [64, 1, 1]},
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

@binding(5) @group(0) var<storage, read_write> blended_0 : array<f32>;

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
    var word_2 : u32 = mean_0[(_S2 >> (_S3))];
    var lane_2 : u32 = (_S2 & ((((u32(1) << (_S3))) - u32(1))));
    var value_0 : f32;
    if(_S3 == u32(0))
    {
        value_0 = (bitcast<f32>((word_2)));
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

fn stored_1( _S7 : vec3<u32>,  _S8 : u32) -> f32
{
    var _S9 : u32 = _S7.x;
    var word_3 : u32 = basis_0[(_S8 >> (_S9))];
    var lane_3 : u32 = (_S8 & ((((u32(1) << (_S9))) - u32(1))));
    var value_1 : f32;
    if(_S9 == u32(0))
    {
        value_1 = (bitcast<f32>((word_3)));
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
            value_1 = _S10 * (bitcast<f32>((basis_0[_S11 + _S12])));
        }
    }
    return value_1;
}

@compute
@workgroup_size(64, 1, 1)
fn BlendLl(@builtin(global_invocation_id) id_0 : vec3<u32>)
{
    var texels_0 : u32 = Constants_0.size_0 * Constants_0.size_0;
    var texel_0 : u32 = id_0.x;
    var channel_0 : u32 = id_0.y;
    var _S13 : bool;
    if(texel_0 >= texels_0)
    {
        _S13 = true;
    }
    else
    {
        _S13 = channel_0 >= (Constants_0.channels_0);
    }
    if(_S13)
    {
        return;
    }
    var _S14 : u32 = channel_0 * texels_0 + texel_0;
    var _S15 : f32 = stored_0(Constants_0.mean_layout_0, _S14);
    var r_0 : u32 = u32(0);
    var sum_0 : f32 = _S15;
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
        var _S16 : f32 = alpha_0[Constants_0.alpha_offset_0 + map_0];
        var _S17 : f32 = stored_1(Constants_0.basis_layout_0, map_0 * texels_0 + texel_0);
        var sum_1 : f32 = sum_0 + _S16 * _S17;
        r_0 = r_0 + u32(1);
        sum_0 = sum_1;
    }
    blended_0[_S14] = sum_0;
    return;
}

`,
};

/** @type {import("../shader.js").Shader} */
export const BlendDetail = {
  ...{"stage": "comp", "entry": "BlendDetail", "buffers": [{"name": "mean", "binding": 0, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "h", "binding": 2, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "w", "binding": 3, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "alpha", "binding": 4, "read_only": true, "scalar": "float", "stride": 4}, {"name": "blended", "binding": 5, "read_only": false, "scalar": "float", "stride": 4}], "constants": [{"name": "mean_layout", "offset": 0, "scalar": "uint", "shape": [3], "strides": [4], "used": true}, {"name": "basis_layout", "offset": 16, "scalar": "uint", "shape": [3], "strides": [4], "used": false}, {"name": "h_layout", "offset": 32, "scalar": "uint", "shape": [3], "strides": [4], "used": true}, {"name": "w_layout", "offset": 48, "scalar": "uint", "shape": [3], "strides": [4], "used": true}, {"name": "channels", "offset": 60, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "rank", "offset": 64, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "size", "offset": 68, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "alpha_offset", "offset": 72, "scalar": "uint", "shape": [], "strides": [], "used": true}], "constants_binding": 6, "threads": [8, 8, 1]},
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

@binding(5) @group(0) var<storage, read_write> blended_0 : array<f32>;

@binding(0) @group(0) var<storage, read> mean_0 : array<u32>;

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

fn stored_0( _S1 : vec3<u32>,  _S2 : u32) -> f32
{
    var _S3 : u32 = _S1.x;
    var word_2 : u32 = h_0[(_S2 >> (_S3))];
    var lane_2 : u32 = (_S2 & ((((u32(1) << (_S3))) - u32(1))));
    var value_0 : f32;
    if(_S3 == u32(0))
    {
        value_0 = (bitcast<f32>((word_2)));
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
        value_2 = (bitcast<f32>((word_3)));
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
        value_4 = (bitcast<f32>((word_4)));
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

@compute
@workgroup_size(8, 8, 1)
fn BlendDetail(@builtin(workgroup_id) group_0 : vec3<u32>, @builtin(local_invocation_id) thread_0 : vec3<u32>, @builtin(local_invocation_index) slot_0 : u32)
{
    var k_0 : u32;
    var i_0 : u32;
    var plane_0 : u32 = group_0.z;
    var _S31 : u32 = plane_0 % Constants_0.channels_0;
    var _S32 : vec2<u32> = group_0.xy * vec2<u32>(u32(24));
    var _S33 : vec3<f32> = vec3<f32>(0.0f);
    var sums_0 : array<vec3<f32>, i32(3)>;
    sums_0[i32(0)] = _S33;
    sums_0[i32(1)] = _S33;
    sums_0[i32(2)] = _S33;
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
            var coefficient_0 : f32 = alpha_0[Constants_0.alpha_offset_0 + _S31 * Constants_0.rank_0 + min(r_0, Constants_0.rank_0 - u32(1))];
            var _S34 : f32 = factor_0(Constants_0.h_layout_0, plane_0, r_0, _S32.y + position_0);
            tileRows_0[i_0] = coefficient_0 * _S34;
            var _S35 : f32 = factor_1(Constants_0.w_layout_0, plane_0, r_0, _S32.x + position_0);
            tileColumns_0[i_0] = _S35;
            i_0 = i_0 + u32(64);
        }
        workgroupBarrier();
        k_0 = u32(0);
        for(;;)
        {
            if(k_0 < u32(16))
            {
            }
            else
            {
                break;
            }
            var _S36 : u32 = k_0 * u32(24);
            var _S37 : u32 = _S36 + thread_0.y;
            var column_0 : u32 = _S36 + thread_0.x;
            var _S38 : vec3<f32> = vec3<f32>(tileColumns_0[column_0], tileColumns_0[column_0 + u32(8)], tileColumns_0[column_0 + u32(16)]);
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
                sums_0[j_0] = sums_0[j_0] + vec3<f32>(tileRows_0[_S37 + j_0 * u32(8)]) * _S38;
                j_0 = j_0 + u32(1);
            }
            k_0 = k_0 + u32(1);
        }
        workgroupBarrier();
        start_0 = start_0 + u32(16);
    }
    k_0 = u32(0);
    for(;;)
    {
        if(k_0 < u32(3))
        {
        }
        else
        {
            break;
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
            var at_0 : vec2<u32> = _S32 + thread_0.xy + vec2<u32>(u32(8)) * vec2<u32>(i_0, k_0);
            var _S39 : u32 = at_0.y;
            var _S40 : u32 = at_0.x;
            var texel_0 : u32 = (plane_0 * Constants_0.size_0 + _S39) * Constants_0.size_0 + _S40;
            var _S41 : bool;
            if(_S40 < (Constants_0.size_0))
            {
                _S41 = _S39 < (Constants_0.size_0);
            }
            else
            {
                _S41 = false;
            }
            if(_S41)
            {
                var _S42 : f32 = stored_2(Constants_0.mean_layout_0, texel_0);
                blended_0[texel_0] = _S42 + sums_0[k_0][i_0];
            }
            i_0 = i_0 + u32(1);
        }
        k_0 = k_0 + u32(1);
    }
    return;
}

`,
};
