// Generated from ComputeShaders/splat_sort.compute by tools/gen_wgsl.py; do not edit.

/** @type {import("../shader.js").Shader} */
export const CountDigits = {
  ...{"stage": "comp", "entry": "CountDigits", "buffers": [{"name": "keys", "binding": 0, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "digit_counts", "binding": 1, "read_only": false, "scalar": "uint", "stride": 4}, {"name": "arguments", "binding": 3, "read_only": false, "scalar": "uint", "stride": 4}], "constants": [{"name": "second_pass", "offset": 0, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "key_count", "offset": 4, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "instances", "offset": 8, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "corners", "offset": 12, "scalar": "uint", "shape": [], "strides": [], "used": false}], "constants_binding": 5, "threads": [256, 1, 1]},
  code: `struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) second_pass_0 : u32,
    @align(4) key_count_0 : u32,
    @align(8) instances_0 : u32,
    @align(4) corners_0 : u32,
};

@binding(5) @group(0) var<uniform> Constants_0 : SLANG_ParameterGroup_Constants_std140_0;
@binding(3) @group(0) var<storage, read_write> arguments_0 : array<u32>;

@binding(0) @group(0) var<storage, read> keys_0 : array<u32>;

@binding(1) @group(0) var<storage, read_write> digit_counts_0 : array<u32>;

fn elementCount_0() -> u32
{
    var _S1 : u32;
    if((Constants_0.second_pass_0) != u32(0))
    {
        _S1 = arguments_0[u32(4)];
    }
    else
    {
        _S1 = Constants_0.key_count_0;
    }
    return _S1;
}

fn wordOf_0( key_0 : u32,  place_0 : u32) -> u32
{
    var _S2 : u32;
    if(key_0 == u32(65535))
    {
        _S2 = u32(4294967295);
    }
    else
    {
        _S2 = (((((((key_0 & (u32(255)))) << (u32(24)))) | (((((key_0 >> (u32(8)))) << (u32(11))))))) | (place_0));
    }
    return _S2;
}

fn loadWords_0( thread_0 : u32,  block_0 : u32,  mine_0 : ptr<function, array<u32, i32(8)>>)
{
    var _S3 : u32 = elementCount_0();
    var _S4 : u32 = u32(8) * thread_0;
    var i_0 : u32;
    var pair_0 : u32;
    if((Constants_0.second_pass_0) != u32(0))
    {
        i_0 = u32(0);
        for(;;)
        {
            if(i_0 < u32(8))
            {
            }
            else
            {
                break;
            }
            var _S5 : u32 = block_0 + _S4 + i_0;
            if(_S5 < _S3)
            {
                pair_0 = keys_0[_S5];
            }
            else
            {
                pair_0 = u32(4294967295);
            }
            (*mine_0)[i_0] = pair_0;
            i_0 = i_0 + u32(1);
        }
    }
    else
    {
        i_0 = u32(0);
        for(;;)
        {
            if(i_0 < u32(8))
            {
            }
            else
            {
                break;
            }
            var element_0 : u32 = block_0 + _S4 + i_0;
            if(element_0 < _S3)
            {
                pair_0 = keys_0[element_0 / u32(2)];
            }
            else
            {
                pair_0 = u32(4294967295);
            }
            var _S6 : u32 = _S4 + i_0;
            (*mine_0)[i_0] = wordOf_0((pair_0 & (u32(65535))), _S6);
            var _S7 : u32;
            if((element_0 + u32(1)) < _S3)
            {
                _S7 = (pair_0 >> (u32(16)));
            }
            else
            {
                _S7 = u32(65535);
            }
            (*mine_0)[i_0 + u32(1)] = wordOf_0(_S7, _S6 + u32(1));
            i_0 = i_0 + u32(2);
        }
    }
    return;
}

var<workgroup> histogram_0 : array<atomic<u32>, i32(256)>;

fn groupCount_0() -> u32
{
    return (elementCount_0() + u32(2048) - u32(1)) / u32(2048);
}

@compute
@workgroup_size(256, 1, 1)
fn CountDigits(@builtin(local_invocation_index) thread_1 : u32, @builtin(workgroup_id) group_0 : vec3<u32>)
{
    var _S8 : u32 = group_0.x;
    var mine_1 : array<u32, i32(8)>;
    loadWords_0(thread_1, _S8 * u32(2048), &(mine_1));
    atomicStore(&(histogram_0[thread_1]), u32(0));
    workgroupBarrier();
    var i_1 : u32 = u32(0);
    for(;;)
    {
        if(i_1 < u32(8))
        {
        }
        else
        {
            break;
        }
        if((mine_1[i_1]) != u32(4294967295))
        {
            var _S9 : u32 = atomicAdd(&(histogram_0[((mine_1[i_1]) >> (u32(24)))]), u32(1));
        }
        i_1 = i_1 + u32(1);
    }
    workgroupBarrier();
    if(_S8 < (groupCount_0()))
    {
        var _S10 : u32 = atomicLoad(&(histogram_0[thread_1]));
        digit_counts_0[thread_1 * groupCount_0() + _S8] = _S10;
    }
    return;
}

`,
};

/** @type {import("../shader.js").Shader} */
export const ScanDigits = {
  ...{"stage": "comp", "entry": "ScanDigits", "buffers": [{"name": "digit_counts", "binding": 1, "read_only": false, "scalar": "uint", "stride": 4}, {"name": "digit_totals", "binding": 2, "read_only": false, "scalar": "uint", "stride": 4}, {"name": "arguments", "binding": 3, "read_only": false, "scalar": "uint", "stride": 4}], "constants": [{"name": "second_pass", "offset": 0, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "key_count", "offset": 4, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "instances", "offset": 8, "scalar": "uint", "shape": [], "strides": [], "used": false}, {"name": "corners", "offset": 12, "scalar": "uint", "shape": [], "strides": [], "used": false}], "constants_binding": 5, "threads": [256, 1, 1]},
  code: `struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) second_pass_0 : u32,
    @align(4) key_count_0 : u32,
    @align(8) instances_0 : u32,
    @align(4) corners_0 : u32,
};

@binding(5) @group(0) var<uniform> Constants_0 : SLANG_ParameterGroup_Constants_std140_0;
@binding(3) @group(0) var<storage, read_write> arguments_0 : array<u32>;

@binding(1) @group(0) var<storage, read_write> digit_counts_0 : array<u32>;

@binding(2) @group(0) var<storage, read_write> digit_totals_0 : array<u32>;

fn elementCount_0() -> u32
{
    var _S1 : u32;
    if((Constants_0.second_pass_0) != u32(0))
    {
        _S1 = arguments_0[u32(4)];
    }
    else
    {
        _S1 = Constants_0.key_count_0;
    }
    return _S1;
}

fn groupCount_0() -> u32
{
    return (elementCount_0() + u32(2048) - u32(1)) / u32(2048);
}

var<workgroup> sums_0 : array<u32, i32(256)>;

@compute
@workgroup_size(256, 1, 1)
fn ScanDigits(@builtin(local_invocation_index) thread_0 : u32, @builtin(workgroup_id) group_0 : vec3<u32>)
{
    var groups_0 : u32 = groupCount_0();
    var run_0 : u32 = (groups_0 + u32(16) - u32(1)) / u32(16);
    var digit_0 : u32 = u32(16) * group_0.x + thread_0 / u32(16);
    var _S2 : u32 = digit_0 * groups_0;
    var _S3 : u32 = thread_0 % u32(16);
    var _S4 : u32 = min(_S3 * run_0, groups_0);
    var _S5 : u32 = min(_S4 + run_0, groups_0);
    var i_0 : u32 = _S4;
    var sum_0 : u32 = u32(0);
    for(;;)
    {
        if(i_0 < _S5)
        {
        }
        else
        {
            break;
        }
        var sum_1 : u32 = sum_0 + digit_counts_0[_S2 + i_0];
        i_0 = i_0 + u32(1);
        sum_0 = sum_1;
    }
    sums_0[thread_0] = sum_0;
    workgroupBarrier();
    i_0 = thread_0 - _S3;
    var before_0 : u32 = u32(0);
    for(;;)
    {
        if(i_0 < thread_0)
        {
        }
        else
        {
            break;
        }
        var before_1 : u32 = before_0 + sums_0[i_0];
        i_0 = i_0 + u32(1);
        before_0 = before_1;
    }
    if(_S3 == u32(15))
    {
        digit_totals_0[digit_0] = before_0 + sum_0;
    }
    i_0 = _S4;
    for(;;)
    {
        if(i_0 < _S5)
        {
        }
        else
        {
            break;
        }
        var _S6 : u32 = _S2 + i_0;
        var count_0 : u32 = digit_counts_0[_S6];
        digit_counts_0[_S6] = before_0;
        var before_2 : u32 = before_0 + count_0;
        i_0 = i_0 + u32(1);
        before_0 = before_2;
    }
    return;
}

`,
};

/** @type {import("../shader.js").Shader} */
export const ScatterDigits = {
  ...{"stage": "comp", "entry": "ScatterDigits", "buffers": [{"name": "keys", "binding": 0, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "digit_counts", "binding": 1, "read_only": false, "scalar": "uint", "stride": 4}, {"name": "digit_totals", "binding": 2, "read_only": false, "scalar": "uint", "stride": 4}, {"name": "arguments", "binding": 3, "read_only": false, "scalar": "uint", "stride": 4}, {"name": "sorted", "binding": 4, "read_only": false, "scalar": "uint", "stride": 4}], "constants": [{"name": "second_pass", "offset": 0, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "key_count", "offset": 4, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "instances", "offset": 8, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "corners", "offset": 12, "scalar": "uint", "shape": [], "strides": [], "used": true}], "constants_binding": 5, "threads": [256, 1, 1]},
  code: `struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) second_pass_0 : u32,
    @align(4) key_count_0 : u32,
    @align(8) instances_0 : u32,
    @align(4) corners_0 : u32,
};

@binding(5) @group(0) var<uniform> Constants_0 : SLANG_ParameterGroup_Constants_std140_0;
@binding(3) @group(0) var<storage, read_write> arguments_0 : array<u32>;

@binding(0) @group(0) var<storage, read> keys_0 : array<u32>;

@binding(2) @group(0) var<storage, read_write> digit_totals_0 : array<u32>;

@binding(1) @group(0) var<storage, read_write> digit_counts_0 : array<u32>;

@binding(4) @group(0) var<storage, read_write> sorted_0 : array<u32>;

fn elementCount_0() -> u32
{
    var _S1 : u32;
    if((Constants_0.second_pass_0) != u32(0))
    {
        _S1 = arguments_0[u32(4)];
    }
    else
    {
        _S1 = Constants_0.key_count_0;
    }
    return _S1;
}

fn wordOf_0( key_0 : u32,  place_0 : u32) -> u32
{
    var _S2 : u32;
    if(key_0 == u32(65535))
    {
        _S2 = u32(4294967295);
    }
    else
    {
        _S2 = (((((((key_0 & (u32(255)))) << (u32(24)))) | (((((key_0 >> (u32(8)))) << (u32(11))))))) | (place_0));
    }
    return _S2;
}

fn loadWords_0( thread_0 : u32,  block_0 : u32,  mine_0 : ptr<function, array<u32, i32(8)>>)
{
    var _S3 : u32 = elementCount_0();
    var _S4 : u32 = u32(8) * thread_0;
    var i_0 : u32;
    var pair_0 : u32;
    if((Constants_0.second_pass_0) != u32(0))
    {
        i_0 = u32(0);
        for(;;)
        {
            if(i_0 < u32(8))
            {
            }
            else
            {
                break;
            }
            var _S5 : u32 = block_0 + _S4 + i_0;
            if(_S5 < _S3)
            {
                pair_0 = keys_0[_S5];
            }
            else
            {
                pair_0 = u32(4294967295);
            }
            (*mine_0)[i_0] = pair_0;
            i_0 = i_0 + u32(1);
        }
    }
    else
    {
        i_0 = u32(0);
        for(;;)
        {
            if(i_0 < u32(8))
            {
            }
            else
            {
                break;
            }
            var element_0 : u32 = block_0 + _S4 + i_0;
            if(element_0 < _S3)
            {
                pair_0 = keys_0[element_0 / u32(2)];
            }
            else
            {
                pair_0 = u32(4294967295);
            }
            var _S6 : u32 = _S4 + i_0;
            (*mine_0)[i_0] = wordOf_0((pair_0 & (u32(65535))), _S6);
            var _S7 : u32;
            if((element_0 + u32(1)) < _S3)
            {
                _S7 = (pair_0 >> (u32(16)));
            }
            else
            {
                _S7 = u32(65535);
            }
            (*mine_0)[i_0 + u32(1)] = wordOf_0(_S7, _S6 + u32(1));
            i_0 = i_0 + u32(2);
        }
    }
    return;
}

fn scanPlace_0( thread_1 : u32) -> u32
{
    return thread_1 + thread_1 / u32(16);
}

var<workgroup> words_0 : array<u32, i32(2048)>;

fn writeCounters_0( place_1 : u32,  bytes_0 : vec4<u32>)
{
    var k_0 : u32 = u32(0);
    for(;;)
    {
        if(k_0 < u32(4))
        {
        }
        else
        {
            break;
        }
        words_0[u32(272) * k_0 + place_1] = bytes_0[k_0];
        k_0 = k_0 + u32(1);
    }
    return;
}

fn counterBytes_0( counts_0 : vec2<u32>) -> vec4<u32>
{
    var _S8 : u32 = counts_0.x;
    var _S9 : u32 = counts_0.y;
    return (vec4<u32>(_S8, (_S8 >> (u32(4))), _S9, (_S9 >> (u32(4)))) & (vec4<u32>(u32(252645135))));
}

fn readCounters_0( place_2 : u32) -> vec4<u32>
{
    var bytes_1 : vec4<u32> = vec4<u32>(vec4<i32>(i32(0)));
    var k_1 : u32 = u32(0);
    for(;;)
    {
        if(k_1 < u32(4))
        {
        }
        else
        {
            break;
        }
        bytes_1[k_1] = words_0[u32(272) * k_1 + place_2];
        k_1 = k_1 + u32(1);
    }
    return bytes_1;
}

fn scanRows_0( thread_2 : u32,  counts_1 : vec2<u32>) -> vec4<u32>
{
    var _S10 : u32 = scanPlace_0(thread_2);
    var k_2 : u32 = u32(0);
    for(;;)
    {
        if(k_2 < u32(2))
        {
        }
        else
        {
            break;
        }
        words_0[u32(272) * k_2 + _S10] = counts_1[k_2];
        k_2 = k_2 + u32(1);
    }
    workgroupBarrier();
    var _S11 : bool = thread_2 < u32(16);
    if(_S11)
    {
        k_2 = u32(16);
    }
    else
    {
        k_2 = u32(0);
    }
    var _S12 : vec4<u32> = vec4<u32>(vec4<i32>(i32(0)));
    var _S13 : u32 = u32(17) * thread_2;
    var i_1 : u32 = u32(0);
    var place_3 : u32 = _S13;
    var sum_0 : vec4<u32> = _S12;
    for(;;)
    {
        if(i_1 < k_2)
        {
        }
        else
        {
            break;
        }
        var next_0 : vec2<u32> = vec2<u32>(vec2<i32>(i32(0)));
        var k_3 : u32 = u32(0);
        for(;;)
        {
            if(k_3 < u32(2))
            {
            }
            else
            {
                break;
            }
            next_0[k_3] = words_0[u32(272) * k_3 + place_3];
            k_3 = k_3 + u32(1);
        }
        writeCounters_0(place_3, sum_0);
        var sum_1 : vec4<u32> = sum_0 + counterBytes_0(next_0);
        var _S14 : u32 = place_3 + u32(1);
        i_1 = i_1 + u32(1);
        place_3 = _S14;
        sum_0 = sum_1;
    }
    if(_S11)
    {
        writeCounters_0(place_3, sum_0);
    }
    workgroupBarrier();
    return readCounters_0(_S10);
}

fn rowCounter_0( row_0 : u32,  bin_0 : u32) -> u32
{
    var _S15 : u32 = (bin_0 & (u32(1)));
    var _S16 : i32;
    if(bin_0 < u32(8))
    {
        _S16 = i32(0);
    }
    else
    {
        _S16 = i32(2);
    }
    return ((((words_0[u32(272) * (_S15 + u32(_S16)) + u32(17) * row_0 + u32(16)]) >> ((u32(4) * ((bin_0 & (u32(6)))))))) & (u32(255)));
}

var<workgroup> scanned_0 : array<u32, i32(272)>;

var<workgroup> rowStarts_0 : array<u32, i32(16)>;

var<workgroup> scanTotal_0 : u32;

fn exclusiveScan_0( thread_3 : u32,  value_0 : u32,  total_0 : ptr<function, u32>) -> u32
{
    scanned_0[scanPlace_0(thread_3)] = value_0;
    workgroupBarrier();
    var _S17 : bool = thread_3 < u32(16);
    var _S18 : i32;
    if(_S17)
    {
        _S18 = i32(16);
    }
    else
    {
        _S18 = i32(0);
    }
    var _S19 : u32 = u32(_S18);
    var i_2 : u32 = u32(0);
    var sum_2 : u32 = u32(0);
    for(;;)
    {
        if(i_2 < _S19)
        {
        }
        else
        {
            break;
        }
        var next_1 : u32 = scanned_0[u32(17) * thread_3 + i_2];
        scanned_0[u32(17) * thread_3 + i_2] = sum_2;
        var sum_3 : u32 = sum_2 + next_1;
        i_2 = i_2 + u32(1);
        sum_2 = sum_3;
    }
    if(_S17)
    {
        rowStarts_0[thread_3] = sum_2;
    }
    workgroupBarrier();
    var _S20 : bool = thread_3 == u32(0);
    if(_S20)
    {
        _S18 = i32(16);
    }
    else
    {
        _S18 = i32(0);
    }
    var _S21 : u32 = u32(_S18);
    i_2 = u32(0);
    sum_2 = u32(0);
    for(;;)
    {
        if(i_2 < _S21)
        {
        }
        else
        {
            break;
        }
        var next_2 : u32 = rowStarts_0[i_2];
        rowStarts_0[i_2] = sum_2;
        var sum_4 : u32 = sum_2 + next_2;
        i_2 = i_2 + u32(1);
        sum_2 = sum_4;
    }
    if(_S20)
    {
        scanTotal_0 = sum_2;
    }
    workgroupBarrier();
    (*total_0) = scanTotal_0;
    return scanned_0[scanPlace_0(thread_3)] + rowStarts_0[thread_3 / u32(16)];
}

fn exclusiveScan_1( thread_4 : u32,  value_1 : u32,  total_1 : ptr<function, u32>) -> u32
{
    scanned_0[scanPlace_0(thread_4)] = value_1;
    workgroupBarrier();
    var _S22 : bool = thread_4 < u32(16);
    var _S23 : i32;
    if(_S22)
    {
        _S23 = i32(16);
    }
    else
    {
        _S23 = i32(0);
    }
    var _S24 : u32 = u32(_S23);
    var i_3 : u32 = u32(0);
    var sum_5 : u32 = u32(0);
    for(;;)
    {
        if(i_3 < _S24)
        {
        }
        else
        {
            break;
        }
        var next_3 : u32 = scanned_0[u32(17) * thread_4 + i_3];
        scanned_0[u32(17) * thread_4 + i_3] = sum_5;
        var sum_6 : u32 = sum_5 + next_3;
        i_3 = i_3 + u32(1);
        sum_5 = sum_6;
    }
    if(_S22)
    {
        rowStarts_0[thread_4] = sum_5;
    }
    workgroupBarrier();
    var _S25 : bool = thread_4 == u32(0);
    if(_S25)
    {
        _S23 = i32(16);
    }
    else
    {
        _S23 = i32(0);
    }
    var _S26 : u32 = u32(_S23);
    i_3 = u32(0);
    sum_5 = u32(0);
    for(;;)
    {
        if(i_3 < _S26)
        {
        }
        else
        {
            break;
        }
        var next_4 : u32 = rowStarts_0[i_3];
        rowStarts_0[i_3] = sum_5;
        var sum_7 : u32 = sum_5 + next_4;
        i_3 = i_3 + u32(1);
        sum_5 = sum_7;
    }
    if(_S25)
    {
        scanTotal_0 = sum_5;
    }
    workgroupBarrier();
    (*total_1) = scanTotal_0;
    return scanned_0[scanPlace_0(thread_4)] + rowStarts_0[thread_4 / u32(16)];
}

fn binByte_0( bytes_2 : vec4<u32>,  bin_1 : u32) -> u32
{
    var pair_1 : vec2<u32>;
    if(bin_1 < u32(8))
    {
        pair_1 = bytes_2.xy;
    }
    else
    {
        pair_1 = bytes_2.zw;
    }
    var _S27 : u32;
    if(((bin_1 & (u32(1)))) != u32(0))
    {
        _S27 = pair_1.y;
    }
    else
    {
        _S27 = pair_1.x;
    }
    return (((_S27 >> ((u32(4) * ((bin_1 & (u32(6)))))))) & (u32(255)));
}

fn splitWords_0( thread_5 : u32,  mine_1 : array<u32, i32(8)>,  bit_0 : u32) -> u32
{
    var _S28 : vec2<u32> = vec2<u32>(vec2<i32>(i32(0)));
    var ranks_0 : array<u32, i32(8)>;
    var i_4 : u32 = u32(0);
    var counts_2 : vec2<u32> = _S28;
    for(;;)
    {
        if(i_4 < u32(8))
        {
        }
        else
        {
            break;
        }
        var bin_2 : u32 = ((((mine_1[i_4]) >> (bit_0))) & (u32(15)));
        var shift_0 : u32 = u32(4) * ((bin_2 & (u32(7))));
        var one_0 : u32;
        if((mine_1[i_4]) != u32(4294967295))
        {
            one_0 = (u32(1) << (shift_0));
        }
        else
        {
            one_0 = u32(0);
        }
        var _S29 : bool = bin_2 < u32(8);
        var _S30 : u32;
        if(_S29)
        {
            _S30 = counts_2.x;
        }
        else
        {
            _S30 = counts_2.y;
        }
        ranks_0[i_4] = (((_S30 >> (shift_0))) & (u32(15)));
        var _S31 : vec2<u32>;
        if(_S29)
        {
            _S31 = vec2<u32>(one_0, u32(0));
        }
        else
        {
            _S31 = vec2<u32>(u32(0), one_0);
        }
        var counts_3 : vec2<u32> = counts_2 + _S31;
        i_4 = i_4 + u32(1);
        counts_2 = counts_3;
    }
    var _S32 : vec4<u32> = scanRows_0(thread_5, counts_2);
    var total_2 : u32;
    var start_0 : u32 = exclusiveScan_0(thread_5, rowCounter_0(thread_5 % u32(16), thread_5 / u32(16)), &(total_2));
    scanned_0[scanPlace_0(thread_5)] = start_0;
    workgroupBarrier();
    i_4 = u32(0);
    for(;;)
    {
        if(i_4 < u32(8))
        {
        }
        else
        {
            break;
        }
        var _S33 : u32 = i_4;
        var bin_3 : u32 = ((((mine_1[i_4]) >> (bit_0))) & (u32(15)));
        if((mine_1[i_4]) != u32(4294967295))
        {
            words_0[scanned_0[u32(17) * bin_3 + thread_5 / u32(16)] + binByte_0(_S32, bin_3) + ranks_0[i_4]] = mine_1[_S33];
        }
        i_4 = i_4 + u32(1);
    }
    workgroupBarrier();
    return total_2;
}

fn orderBlock_0( thread_6 : u32,  block_1 : u32) -> u32
{
    var mine_2 : array<u32, i32(8)>;
    loadWords_0(thread_6, block_1, &(mine_2));
    var _S34 : u32 = splitWords_0(thread_6, mine_2, u32(24));
    var i_5 : u32 = u32(0);
    for(;;)
    {
        if(i_5 < u32(8))
        {
        }
        else
        {
            break;
        }
        var _S35 : u32 = u32(8) * thread_6 + i_5;
        var _S36 : u32;
        if(_S35 < _S34)
        {
            _S36 = words_0[_S35];
        }
        else
        {
            _S36 = u32(4294967295);
        }
        mine_2[i_5] = _S36;
        i_5 = i_5 + u32(1);
    }
    workgroupBarrier();
    var live_0 : u32 = splitWords_0(thread_6, mine_2, u32(28));
    return live_0;
}

fn groupCount_0() -> u32
{
    return (elementCount_0() + u32(2048) - u32(1)) / u32(2048);
}

fn placeDigits_0( thread_7 : u32,  group_0 : u32,  groups_0 : u32) -> u32
{
    var digits_0 : u32 = digit_totals_0[thread_7];
    var mine_3 : u32;
    var earlier_0 : u32;
    if(group_0 < groups_0)
    {
        var _S37 : u32 = thread_7 * groups_0 + group_0;
        var earlier_1 : u32 = digit_counts_0[_S37];
        if((group_0 + u32(1)) < groups_0)
        {
            mine_3 = digit_counts_0[_S37 + u32(1)];
        }
        else
        {
            mine_3 = digits_0;
        }
        mine_3 = mine_3 - earlier_1;
        earlier_0 = earlier_1;
    }
    else
    {
        mine_3 = u32(0);
        earlier_0 = u32(0);
    }
    var total_3 : u32;
    var _S38 : u32 = exclusiveScan_1(thread_7, digits_0 - mine_3, &(total_3));
    scanned_0[scanPlace_0(thread_7)] = _S38 + earlier_0;
    workgroupBarrier();
    return total_3;
}

fn writeArguments_0( total_4 : u32)
{
    arguments_0[i32(0)] = Constants_0.corners_0 * total_4;
    arguments_0[i32(1)] = Constants_0.instances_0;
    arguments_0[i32(2)] = u32(0);
    arguments_0[i32(3)] = u32(0);
    arguments_0[u32(4)] = total_4;
    return;
}

fn sortedElement_0( word_0 : u32,  block_2 : u32) -> u32
{
    var first_0 : u32 = (((((((word_0 >> (u32(11)))) & (u32(255)))) << (u32(24)))) | ((block_2 + ((word_0 & (u32(2047)))))));
    var _S39 : u32;
    if((Constants_0.second_pass_0) != u32(0))
    {
        _S39 = (word_0 & (u32(16777215)));
    }
    else
    {
        _S39 = first_0;
    }
    return _S39;
}

@compute
@workgroup_size(256, 1, 1)
fn ScatterDigits(@builtin(local_invocation_index) thread_8 : u32, @builtin(workgroup_id) group_1 : vec3<u32>)
{
    var _S40 : u32 = group_1.x;
    var block_3 : u32 = _S40 * u32(2048);
    var live_1 : u32 = orderBlock_0(thread_8, block_3);
    var others_0 : u32 = placeDigits_0(thread_8, _S40, groupCount_0());
    var _S41 : bool;
    if((Constants_0.second_pass_0) == u32(0))
    {
        _S41 = _S40 == u32(0);
    }
    else
    {
        _S41 = false;
    }
    if(_S41)
    {
        _S41 = thread_8 == u32(0);
    }
    else
    {
        _S41 = false;
    }
    if(_S41)
    {
        writeArguments_0(others_0 + live_1);
    }
    var i_6 : u32 = thread_8;
    for(;;)
    {
        if(i_6 < live_1)
        {
        }
        else
        {
            break;
        }
        sorted_0[scanned_0[scanPlace_0(((words_0[i_6]) >> (u32(24))))] + i_6] = sortedElement_0(words_0[i_6], block_3);
        i_6 = i_6 + u32(256);
    }
    return;
}

`,
};
