// Generated from ComputeShaders/inverse_dwt.compute by tools/gen_wgsl.py; do not edit.

/** @type {import("../shader.js").Shader} */
export const InverseDwt = {
  ...{"stage": "comp", "entry": "InverseDwt", "buffers": [{"name": "ll", "binding": 0, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "details", "binding": 1, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "rec_lo", "binding": 2, "read_only": true, "scalar": "float", "stride": 4}, {"name": "rec_hi", "binding": 3, "read_only": true, "scalar": "float", "stride": 4}, {"name": "fine", "binding": 7, "read_only": false, "scalar": "uint", "stride": 4}], "constants": [{"name": "static_offset_layout", "offset": 0, "scalar": "uint", "shape": [3], "strides": [4], "used": false}, {"name": "channels", "offset": 12, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "size", "offset": 16, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "taps", "offset": 20, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "factor", "offset": 24, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "reach", "offset": 28, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "delay", "offset": 32, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "texel_count", "offset": 36, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "first_row", "offset": 40, "scalar": "uint", "shape": [], "strides": [], "used": false}], "constants_binding": 9, "threads": [16, 16, 1]},
  code: `struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) static_offset_layout_0 : vec3<u32>,
    @align(4) channels_0 : u32,
    @align(16) size_0 : u32,
    @align(4) taps_0 : u32,
    @align(8) factor_0 : u32,
    @align(4) reach_0 : u32,
    @align(16) delay_0 : u32,
    @align(4) texel_count_0 : u32,
    @align(8) first_row_0 : u32,
};

@binding(9) @group(0) var<uniform> Constants_0 : SLANG_ParameterGroup_Constants_std140_0;
@binding(0) @group(0) var<storage, read> ll_0 : array<u32>;

@binding(2) @group(0) var<storage, read> rec_lo_0 : array<f32>;

@binding(1) @group(0) var<storage, read> details_0 : array<u32>;

@binding(3) @group(0) var<storage, read> rec_hi_0 : array<f32>;

@binding(7) @group(0) var<storage, read_write> fine_0 : array<u32>;

fn rowCount_0() -> u32
{
    return u32(16) + Constants_0.taps_0 / u32(2) - u32(1);
}

fn coarseRow_0( tile_0 : u32,  i_0 : u32) -> u32
{
    var _S1 : u32 = (tile_0 * u32(16) + i_0 + Constants_0.taps_0 * Constants_0.size_0 - (Constants_0.taps_0 / u32(2) - u32(1))) % Constants_0.size_0;
    return _S1;
}

var<workgroup> filtered_0 : array<vec2<f32>, i32(576)>;

fn rowWords_0( size_1 : u32) -> u32
{
    return (size_1 + u32(1)) / u32(2);
}

fn halfAt_0( word_0 : u32,  lane_0 : u32) -> f32
{
    return (unpack2x16float(((((word_0 >> ((u32(16) * lane_0)))) & (u32(65535))))).x);
}

fn olderSample_0( sample_0 : u32) -> u32
{
    var _S2 : u32;
    if(sample_0 == u32(0))
    {
        _S2 = Constants_0.size_0;
    }
    else
    {
        _S2 = sample_0;
    }
    return _S2 - u32(1);
}

fn packHalves_0( values_0 : vec2<f32>) -> u32
{
    return ((pack2x16float(vec2f((values_0.x),0.0))) | ((((pack2x16float(vec2f((values_0.y),0.0))) << (u32(16))))));
}

fn packBounded_0( values_1 : vec2<f32>) -> u32
{
    return packHalves_0(clamp(values_1, vec2<f32>(-65504.0f), vec2<f32>(65504.0f)));
}

fn writeSquare_0( coarse_0 : vec3<u32>,  square_0 : vec4<f32>)
{
    var _S3 : bool;
    if((coarse_0.x) >= (Constants_0.size_0))
    {
        _S3 = true;
    }
    else
    {
        _S3 = (coarse_0.y) >= (Constants_0.size_0);
    }
    if(_S3)
    {
        return;
    }
    var side_0 : u32 = u32(2) * Constants_0.size_0;
    var near_0 : vec2<u32> = (vec2<u32>(u32(2)) * coarse_0.xy + vec2<u32>((Constants_0.taps_0 * Constants_0.size_0)) - vec2<u32>((Constants_0.taps_0 / u32(2) - u32(1)))) % vec2<u32>(side_0);
    var start_0 : u32 = (coarse_0.z * side_0 + near_0.y) * Constants_0.size_0 + near_0.x / u32(2);
    fine_0[start_0] = packBounded_0(square_0.xy);
    fine_0[start_0 + Constants_0.size_0] = packBounded_0(square_0.zw);
    return;
}

fn tapPair_0( _S4 : u32) -> vec2<f32>
{
    var _S5 : u32 = u32(2) * _S4;
    return vec2<f32>(rec_lo_0[_S5], rec_lo_0[_S5 + u32(1)]);
}

fn sampleAt_0( _S6 : u32,  _S7 : u32) -> f32
{
    return halfAt_0(ll_0[_S6 + _S7 / u32(2)], (_S7 & (u32(1))));
}

fn filterRow_0( _S8 : u32,  _S9 : u32,  _S10 : u32) -> vec2<f32>
{
    var _S11 : u32 = (_S8 * Constants_0.size_0 + _S9) * rowWords_0(Constants_0.size_0);
    var _S12 : vec2<f32> = vec2<f32>(vec2<i32>(i32(0)));
    var older_0 : u32 = min(_S10, Constants_0.size_0 - u32(1));
    var j_0 : u32 = u32(0);
    var pair_0 : vec2<f32> = _S12;
    for(;;)
    {
        if(j_0 < (Constants_0.taps_0 / u32(2)))
        {
        }
        else
        {
            break;
        }
        var pair_1 : vec2<f32> = pair_0 + tapPair_0(j_0) * vec2<f32>(sampleAt_0(_S11, older_0));
        var _S13 : u32 = olderSample_0(older_0);
        var _S14 : u32 = j_0 + u32(1);
        older_0 = _S13;
        j_0 = _S14;
        pair_0 = pair_1;
    }
    return pair_0;
}

fn tapPair_1( _S15 : u32) -> vec2<f32>
{
    var _S16 : u32 = u32(2) * _S15;
    return vec2<f32>(rec_hi_0[_S16], rec_hi_0[_S16 + u32(1)]);
}

fn sampleAt_1( _S17 : u32,  _S18 : u32) -> f32
{
    return halfAt_0(details_0[_S17 + _S18 / u32(2)], (_S18 & (u32(1))));
}

fn filterRow_1( _S19 : u32,  _S20 : u32,  _S21 : u32) -> vec2<f32>
{
    var _S22 : u32 = (_S19 * Constants_0.size_0 + _S20) * rowWords_0(Constants_0.size_0);
    var _S23 : vec2<f32> = vec2<f32>(vec2<i32>(i32(0)));
    var older_1 : u32 = min(_S21, Constants_0.size_0 - u32(1));
    var j_1 : u32 = u32(0);
    var pair_2 : vec2<f32> = _S23;
    for(;;)
    {
        if(j_1 < (Constants_0.taps_0 / u32(2)))
        {
        }
        else
        {
            break;
        }
        var pair_3 : vec2<f32> = pair_2 + tapPair_1(j_1) * vec2<f32>(sampleAt_1(_S22, older_1));
        var _S24 : u32 = olderSample_0(older_1);
        var _S25 : u32 = j_1 + u32(1);
        older_1 = _S24;
        j_1 = _S25;
        pair_2 = pair_3;
    }
    return pair_2;
}

fn filterColumns_0( _S26 : vec2<u32>) -> vec4<f32>
{
    var _S27 : u32 = _S26.y + Constants_0.taps_0 / u32(2) - u32(1);
    var _S28 : vec4<f32> = vec4<f32>(vec4<i32>(i32(0)));
    var j_2 : u32 = u32(0);
    var square_1 : vec4<f32> = _S28;
    for(;;)
    {
        if(j_2 < (Constants_0.taps_0 / u32(2)))
        {
        }
        else
        {
            break;
        }
        var square_2 : vec4<f32> = square_1 + tapPair_0(j_2).xxyy * filtered_0[(_S27 - j_2) * u32(16) + _S26.x].xyxy;
        j_2 = j_2 + u32(1);
        square_1 = square_2;
    }
    return square_1;
}

fn filterRow_2( _S29 : u32,  _S30 : u32,  _S31 : u32) -> vec2<f32>
{
    var _S32 : u32 = (_S29 * Constants_0.size_0 + _S30) * rowWords_0(Constants_0.size_0);
    var _S33 : vec2<f32> = vec2<f32>(vec2<i32>(i32(0)));
    var older_2 : u32 = min(_S31, Constants_0.size_0 - u32(1));
    var j_3 : u32 = u32(0);
    var pair_4 : vec2<f32> = _S33;
    for(;;)
    {
        if(j_3 < (Constants_0.taps_0 / u32(2)))
        {
        }
        else
        {
            break;
        }
        var pair_5 : vec2<f32> = pair_4 + tapPair_0(j_3) * vec2<f32>(sampleAt_1(_S32, older_2));
        var _S34 : u32 = olderSample_0(older_2);
        var _S35 : u32 = j_3 + u32(1);
        older_2 = _S34;
        j_3 = _S35;
        pair_4 = pair_5;
    }
    return pair_4;
}

fn filterColumns_1( _S36 : vec2<u32>) -> vec4<f32>
{
    var _S37 : u32 = _S36.y + Constants_0.taps_0 / u32(2) - u32(1);
    var _S38 : vec4<f32> = vec4<f32>(vec4<i32>(i32(0)));
    var j_4 : u32 = u32(0);
    var square_3 : vec4<f32> = _S38;
    for(;;)
    {
        if(j_4 < (Constants_0.taps_0 / u32(2)))
        {
        }
        else
        {
            break;
        }
        var square_4 : vec4<f32> = square_3 + tapPair_1(j_4).xxyy * filtered_0[(_S37 - j_4) * u32(16) + _S36.x].xyxy;
        j_4 = j_4 + u32(1);
        square_3 = square_4;
    }
    return square_3;
}

@compute
@workgroup_size(16, 16, 1)
fn InverseDwt(@builtin(global_invocation_id) id_0 : vec3<u32>, @builtin(workgroup_id) group_0 : vec3<u32>, @builtin(local_invocation_id) thread_0 : vec3<u32>)
{
    var _S39 : u32;
    var _S40 : u32 = thread_0.y;
    var i_1 : u32 = _S40;
    for(;;)
    {
        var _S41 : u32 = rowCount_0();
        _S39 = _S41;
        if(i_1 < _S41)
        {
        }
        else
        {
            break;
        }
        var row_0 : u32 = coarseRow_0(group_0.y, i_1);
        var _S42 : u32 = id_0.z;
        var _S43 : u32 = id_0.x;
        filtered_0[i_1 * u32(16) + thread_0.x] = filterRow_0(_S42, row_0, _S43) + filterRow_1(Constants_0.channels_0 + _S42, row_0, _S43);
        i_1 = i_1 + u32(16);
    }
    workgroupBarrier();
    var _S44 : vec2<u32> = thread_0.xy;
    var _S45 : vec4<f32> = filterColumns_0(_S44);
    workgroupBarrier();
    i_1 = _S40;
    for(;;)
    {
        if(i_1 < _S39)
        {
        }
        else
        {
            break;
        }
        var row_1 : u32 = coarseRow_0(group_0.y, i_1);
        var _S46 : u32 = id_0.z;
        var _S47 : u32 = id_0.x;
        filtered_0[i_1 * u32(16) + thread_0.x] = filterRow_2(_S46, row_1, _S47) + filterRow_1(u32(2) * Constants_0.channels_0 + _S46, row_1, _S47);
        i_1 = i_1 + u32(16);
    }
    workgroupBarrier();
    writeSquare_0(id_0, _S45 + filterColumns_1(_S44));
    return;
}

`,
};

/** @type {import("../shader.js").Shader} */
export const UpsampleTexels = {
  ...{"stage": "comp", "entry": "UpsampleTexels", "buffers": [{"name": "ll", "binding": 0, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "upsampling", "binding": 4, "read_only": true, "scalar": "float", "stride": 4}, {"name": "tiles", "binding": 5, "read_only": true, "scalar": "uint", "stride": 8}, {"name": "static_offset", "binding": 6, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "texel_channels", "binding": 8, "read_only": false, "scalar": "uint", "stride": 8}], "constants": [{"name": "static_offset_layout", "offset": 0, "scalar": "uint", "shape": [3], "strides": [4], "used": true}, {"name": "channels", "offset": 12, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "size", "offset": 16, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "taps", "offset": 20, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "factor", "offset": 24, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "reach", "offset": 28, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "delay", "offset": 32, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "texel_count", "offset": 36, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "first_row", "offset": 40, "scalar": "uint", "shape": [], "strides": [], "used": true}], "constants_binding": 9, "threads": [16, 16, 1]},
  code: `struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) static_offset_layout_0 : vec3<u32>,
    @align(4) channels_0 : u32,
    @align(16) size_0 : u32,
    @align(4) taps_0 : u32,
    @align(8) factor_0 : u32,
    @align(4) reach_0 : u32,
    @align(16) delay_0 : u32,
    @align(4) texel_count_0 : u32,
    @align(8) first_row_0 : u32,
};

@binding(9) @group(0) var<uniform> Constants_0 : SLANG_ParameterGroup_Constants_std140_0;
@binding(5) @group(0) var<storage, read> tiles_0 : array<vec2<u32>>;

@binding(0) @group(0) var<storage, read> ll_0 : array<u32>;

@binding(4) @group(0) var<storage, read> upsampling_0 : array<f32>;

@binding(6) @group(0) var<storage, read> static_offset_0 : array<u32>;

@binding(8) @group(0) var<storage, read_write> texel_channels_0 : array<vec2<u32>>;

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

fn tileRow_0( tile_3 : u32,  row_2 : u32) -> vec2<u32>
{
    return tiles_0[u32(17) * tile_3 + u32(1) + row_2];
}

fn isIn_0( columns_0 : u32,  column_1 : u32) -> bool
{
    return ((((columns_0 >> (column_1))) & (u32(1)))) != u32(0);
}

fn texelOf_0( run_0 : vec2<u32>,  column_2 : u32) -> u32
{
    return run_0.x + countOneBits(((run_0.y) & ((((u32(1) << (column_2))) - u32(1)))));
}

fn upsampleColumn_0( newest_0 : u32,  tap_2 : u32,  column_3 : u32) -> vec4<f32>
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
        var sum_3 : vec4<f32> = sum_2 + vec4<f32>(upsampling_0[Constants_0.factor_0 * j_1 + tap_2]) * upsampled_0[(newest_0 - j_1) * u32(16) + column_3];
        j_1 = j_1 + u32(1);
        sum_2 = sum_3;
    }
    return sum_2;
}

fn batchAt_0( tile_4 : u32,  thread_1 : vec2<u32>) -> vec4<f32>
{
    var position_2 : u32 = cornerOf_0(tile_4).y + thread_1.y;
    var _S20 : u32 = newestSample_0(position_2);
    var _S21 : u32 = firstSample_0(tile_4);
    var newest_1 : u32 = _S20 - _S21 + Constants_0.reach_0 - u32(1);
    var _S22 : u32 = phase_0(position_2);
    return upsampleColumn_0(newest_1, _S22, thread_1.x);
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

fn packHalves_0( values_1 : vec2<f32>) -> u32
{
    return ((pack2x16float(vec2f((values_1.x),0.0))) | ((((pack2x16float(vec2f((values_1.y),0.0))) << (u32(16))))));
}

fn packBounded_0( values_2 : vec2<f32>) -> u32
{
    return packHalves_0(clamp(values_2, vec2<f32>(-65504.0f), vec2<f32>(65504.0f)));
}

fn writeTexel_0( texel_1 : u32,  row_3 : u32,  values_3 : vec4<f32>)
{
    texel_channels_0[row_3 * Constants_0.texel_count_0 + texel_1] = vec2<u32>(packBounded_0(values_3.xy), packBounded_0(values_3.zw));
    return;
}

@compute
@workgroup_size(16, 16, 1)
fn UpsampleTexels(@builtin(workgroup_id) group_0 : vec3<u32>, @builtin(local_invocation_id) thread_2 : vec3<u32>)
{
    var _S31 : u32 = group_0.z;
    var first_2 : u32 = u32(4) * _S31;
    var _S32 : u32 = group_0.x;
    var _S33 : vec2<u32> = thread_2.xy;
    loadBatch_0(_S32, _S33, first_2);
    workgroupBarrier();
    var run_1 : vec2<u32> = tileRow_0(_S32, thread_2.y);
    var _S34 : u32 = thread_2.x;
    if(!isIn_0(run_1.y, _S34))
    {
        return;
    }
    var texel_2 : u32 = texelOf_0(run_1, _S34);
    var _S35 : u32 = Constants_0.first_row_0 + _S31;
    var _S36 : vec4<f32> = batchAt_0(_S32, _S33);
    var _S37 : vec4<f32> = withStatic_0(_S36, texel_2, first_2);
    writeTexel_0(texel_2, _S35, _S37);
    return;
}

`,
};
