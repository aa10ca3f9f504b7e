// Generated from ComputeShaders/splat_sort.compute by tools/gen_wgsl.py; do not edit.

/** @type {import("../shader.js").Shader} */
export const CountDigits = {
  ...{"stage": "comp", "entry": "CountDigits", "buffers": [{"name": "keys", "binding": 0, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "digit_counts", "binding": 1, "read_only": false, "scalar": "uint", "stride": 4}, {"name": "arguments", "binding": 3, "read_only": false, "scalar": "uint", "stride": 4}], "constants": [{"name": "second_pass", "offset": 0, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "key_count", "offset": 4, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "instances", "offset": 8, "scalar": "uint", "shape": [], "strides": [], "used": false}], "constants_binding": 5, "threads": [256, 1, 1]},
  code: `struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) second_pass_0 : u32,
    @align(4) key_count_0 : u32,
    @align(8) instances_0 : u32,
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

var<workgroup> histogram_0 : array<atomic<u32>, i32(256)>;

fn keyOf_0( element_0 : u32,  count_0 : u32) -> u32
{
    var key_0 : u32;
    if(element_0 < count_0)
    {
        if((Constants_0.second_pass_0) != u32(0))
        {
            key_0 = (keys_0[element_0] >> (u32(24)));
        }
        else
        {
            key_0 = (((keys_0[element_0 / u32(2)] >> ((u32(16) * ((element_0 & (u32(1)))))))) & (u32(65535)));
        }
    }
    else
    {
        key_0 = u32(65535);
    }
    return key_0;
}

fn groupCount_0() -> u32
{
    return (elementCount_0() + u32(2048) - u32(1)) / u32(2048);
}

@compute
@workgroup_size(256, 1, 1)
fn CountDigits(@builtin(local_invocation_index) thread_0 : u32, @builtin(workgroup_id) group_0 : vec3<u32>)
{
    var _S2 : u32 = elementCount_0();
    atomicStore(&(histogram_0[thread_0]), u32(0));
    workgroupBarrier();
    var i_0 : u32 = u32(0);
    for(;;)
    {
        if(i_0 < u32(8))
        {
        }
        else
        {
            break;
        }
        var key_1 : u32 = keyOf_0(group_0.x * u32(2048) + u32(8) * thread_0 + i_0, _S2);
        if(key_1 != u32(65535))
        {
            var _S3 : u32 = atomicAdd(&(histogram_0[(key_1 & (u32(255)))]), u32(1));
        }
        i_0 = i_0 + u32(1);
    }
    workgroupBarrier();
    var _S4 : u32 = group_0.x;
    if(_S4 < (groupCount_0()))
    {
        var _S5 : u32 = atomicLoad(&(histogram_0[thread_0]));
        digit_counts_0[thread_0 * groupCount_0() + _S4] = _S5;
    }
    return;
}

`,
};

/** @type {import("../shader.js").Shader} */
export const ScanDigits = {
  ...{"stage": "comp", "entry": "ScanDigits", "buffers": [{"name": "digit_counts", "binding": 1, "read_only": false, "scalar": "uint", "stride": 4}, {"name": "digit_totals", "binding": 2, "read_only": false, "scalar": "uint", "stride": 4}, {"name": "arguments", "binding": 3, "read_only": false, "scalar": "uint", "stride": 4}], "constants": [{"name": "second_pass", "offset": 0, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "key_count", "offset": 4, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "instances", "offset": 8, "scalar": "uint", "shape": [], "strides": [], "used": false}], "constants_binding": 5, "threads": [256, 1, 1]},
  code: `struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) second_pass_0 : u32,
    @align(4) key_count_0 : u32,
    @align(8) instances_0 : u32,
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

var<workgroup> scanned_0 : array<vec2<u32>, i32(256)>;

fn exclusiveScan_0( thread_0 : u32,  value_0 : vec2<u32>,  total_0 : ptr<function, vec2<u32>>) -> vec2<u32>
{
    scanned_0[thread_0] = value_0;
    workgroupBarrier();
    var reach_0 : u32 = u32(1);
    for(;;)
    {
        if(reach_0 < u32(256))
        {
        }
        else
        {
            break;
        }
        var sum_0 : vec2<u32> = scanned_0[thread_0];
        var sum_1 : vec2<u32>;
        if(thread_0 >= reach_0)
        {
            sum_1 = sum_0 + scanned_0[thread_0 - reach_0];
        }
        else
        {
            sum_1 = sum_0;
        }
        workgroupBarrier();
        scanned_0[thread_0] = sum_1;
        workgroupBarrier();
        reach_0 = reach_0 * u32(2);
    }
    (*total_0) = scanned_0[i32(255)];
    var before_0 : vec2<u32> = scanned_0[thread_0] - value_0;
    workgroupBarrier();
    return before_0;
}

@compute
@workgroup_size(256, 1, 1)
fn ScanDigits(@builtin(local_invocation_index) thread_1 : u32, @builtin(workgroup_id) group_0 : vec3<u32>)
{
    var groups_0 : u32 = groupCount_0();
    var run_0 : u32 = (groups_0 + u32(256) - u32(1)) / u32(256);
    var _S2 : u32 = group_0.x;
    var _S3 : u32 = _S2 * groups_0;
    var _S4 : u32 = min(thread_1 * run_0, groups_0);
    var _S5 : u32 = min(_S4 + run_0, groups_0);
    var i_0 : u32 = _S4;
    var sum_2 : u32 = u32(0);
    for(;;)
    {
        if(i_0 < _S5)
        {
        }
        else
        {
            break;
        }
        var sum_3 : u32 = sum_2 + digit_counts_0[_S3 + i_0];
        i_0 = i_0 + u32(1);
        sum_2 = sum_3;
    }
    var total_1 : vec2<u32>;
    var _S6 : vec2<u32> = exclusiveScan_0(thread_1, vec2<u32>(sum_2, u32(0)), &(total_1));
    var _S7 : u32 = _S6.x;
    i_0 = _S4;
    var before_1 : u32 = _S7;
    for(;;)
    {
        if(i_0 < _S5)
        {
        }
        else
        {
            break;
        }
        var _S8 : u32 = _S3 + i_0;
        var count_0 : u32 = digit_counts_0[_S8];
        digit_counts_0[_S8] = before_1;
        var before_2 : u32 = before_1 + count_0;
        i_0 = i_0 + u32(1);
        before_1 = before_2;
    }
    if(thread_1 == u32(0))
    {
        digit_totals_0[_S2] = total_1.x;
    }
    return;
}

`,
};

/** @type {import("../shader.js").Shader} */
export const ScatterDigits = {
  ...{"stage": "comp", "entry": "ScatterDigits", "buffers": [{"name": "keys", "binding": 0, "read_only": true, "scalar": "uint", "stride": 4}, {"name": "digit_counts", "binding": 1, "read_only": false, "scalar": "uint", "stride": 4}, {"name": "digit_totals", "binding": 2, "read_only": false, "scalar": "uint", "stride": 4}, {"name": "arguments", "binding": 3, "read_only": false, "scalar": "uint", "stride": 4}, {"name": "sorted", "binding": 4, "read_only": false, "scalar": "uint", "stride": 4}], "constants": [{"name": "second_pass", "offset": 0, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "key_count", "offset": 4, "scalar": "uint", "shape": [], "strides": [], "used": true}, {"name": "instances", "offset": 8, "scalar": "uint", "shape": [], "strides": [], "used": true}], "constants_binding": 5, "threads": [256, 1, 1]},
  code: `struct SLANG_ParameterGroup_Constants_std140_0
{
    @align(16) second_pass_0 : u32,
    @align(4) key_count_0 : u32,
    @align(8) instances_0 : u32,
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

fn keyOf_0( element_0 : u32,  count_0 : u32) -> u32
{
    var key_0 : u32;
    if(element_0 < count_0)
    {
        if((Constants_0.second_pass_0) != u32(0))
        {
            key_0 = (keys_0[element_0] >> (u32(24)));
        }
        else
        {
            key_0 = (((keys_0[element_0 / u32(2)] >> ((u32(16) * ((element_0 & (u32(1)))))))) & (u32(65535)));
        }
    }
    else
    {
        key_0 = u32(65535);
    }
    return key_0;
}

var<workgroup> scanned_0 : array<vec2<u32>, i32(256)>;

fn exclusiveScan_0( thread_0 : u32,  value_0 : vec2<u32>,  total_0 : ptr<function, vec2<u32>>) -> vec2<u32>
{
    scanned_0[thread_0] = value_0;
    workgroupBarrier();
    var reach_0 : u32 = u32(1);
    for(;;)
    {
        if(reach_0 < u32(256))
        {
        }
        else
        {
            break;
        }
        var sum_0 : vec2<u32> = scanned_0[thread_0];
        var sum_1 : vec2<u32>;
        if(thread_0 >= reach_0)
        {
            sum_1 = sum_0 + scanned_0[thread_0 - reach_0];
        }
        else
        {
            sum_1 = sum_0;
        }
        workgroupBarrier();
        scanned_0[thread_0] = sum_1;
        workgroupBarrier();
        reach_0 = reach_0 * u32(2);
    }
    (*total_0) = scanned_0[i32(255)];
    var before_0 : vec2<u32> = scanned_0[thread_0] - value_0;
    workgroupBarrier();
    return before_0;
}

fn exclusiveScan_1( thread_1 : u32,  value_1 : vec2<u32>,  total_1 : ptr<function, vec2<u32>>) -> vec2<u32>
{
    scanned_0[thread_1] = value_1;
    workgroupBarrier();
    var reach_1 : u32 = u32(1);
    for(;;)
    {
        if(reach_1 < u32(256))
        {
        }
        else
        {
            break;
        }
        var sum_2 : vec2<u32> = scanned_0[thread_1];
        var sum_3 : vec2<u32>;
        if(thread_1 >= reach_1)
        {
            sum_3 = sum_2 + scanned_0[thread_1 - reach_1];
        }
        else
        {
            sum_3 = sum_2;
        }
        workgroupBarrier();
        scanned_0[thread_1] = sum_3;
        workgroupBarrier();
        reach_1 = reach_1 * u32(2);
    }
    (*total_1) = scanned_0[i32(255)];
    var before_1 : vec2<u32> = scanned_0[thread_1] - value_1;
    workgroupBarrier();
    return before_1;
}

var<workgroup> words_0 : array<u32, i32(2048)>;

fn loadWords_0( thread_2 : u32,  block_0 : u32,  count_1 : u32) -> u32
{
    var mine_0 : array<u32, i32(8)>;
    var i_0 : u32 = u32(0);
    var shown_0 : u32 = u32(0);
    for(;;)
    {
        if(i_0 < u32(8))
        {
        }
        else
        {
            break;
        }
        var _S2 : u32 = keyOf_0(block_0 + u32(8) * thread_2 + i_0, count_1);
        mine_0[i_0] = _S2;
        var _S3 : i32;
        if(_S2 != u32(65535))
        {
            _S3 = i32(1);
        }
        else
        {
            _S3 = i32(0);
        }
        var shown_1 : u32 = shown_0 + u32(_S3);
        i_0 = i_0 + u32(1);
        shown_0 = shown_1;
    }
    var total_2 : vec2<u32>;
    var _S4 : vec2<u32> = exclusiveScan_0(thread_2, vec2<u32>(shown_0, u32(0)), &(total_2));
    var _S5 : u32 = _S4.x;
    i_0 = u32(0);
    var next_0 : u32 = _S5;
    for(;;)
    {
        if(i_0 < u32(8))
        {
        }
        else
        {
            break;
        }
        if((mine_0[i_0]) != u32(65535))
        {
            words_0[next_0] = ((((mine_0[i_0]) << (u32(11)))) | ((u32(8) * thread_2 + i_0)));
            next_0 = next_0 + u32(1);
        }
        i_0 = i_0 + u32(1);
    }
    i_0 = total_2.x + thread_2;
    for(;;)
    {
        if(i_0 < u32(2048))
        {
        }
        else
        {
            break;
        }
        words_0[i_0] = u32(134215680);
        i_0 = i_0 + u32(256);
    }
    return total_2.x;
}

var<workgroup> places_0 : array<u32, i32(256)>;

fn groupCount_0() -> u32
{
    return (elementCount_0() + u32(2048) - u32(1)) / u32(2048);
}

fn writeArguments_0( total_3 : u32)
{
    arguments_0[i32(0)] = u32(6) * total_3;
    arguments_0[i32(1)] = Constants_0.instances_0;
    arguments_0[i32(2)] = u32(0);
    arguments_0[i32(3)] = u32(0);
    arguments_0[u32(4)] = total_3;
    return;
}

fn counterShift_0( bin_0 : u32) -> u32
{
    return u32(16) * ((bin_0 & (u32(1))));
}

fn counterOne_0( bin_1 : u32) -> vec2<u32>
{
    var one_0 : u32 = (u32(1) << ((counterShift_0(bin_1))));
    var _S6 : vec2<u32>;
    if(bin_1 < u32(2))
    {
        _S6 = vec2<u32>(one_0, u32(0));
    }
    else
    {
        _S6 = vec2<u32>(u32(0), one_0);
    }
    return _S6;
}

fn counterStarts_0( totals_0 : vec2<u32>) -> vec2<u32>
{
    var _S7 : u32 = totals_0.x;
    var first_0 : u32 = (_S7 & (u32(65535)));
    var second_0 : u32 = first_0 + ((_S7 >> (u32(16))));
    return vec2<u32>((first_0 << (u32(16))), (second_0 | ((((second_0 + (((totals_0.y) & (u32(65535))))) << (u32(16)))))));
}

fn counterOf_0( counters_0 : vec2<u32>,  bin_2 : u32) -> u32
{
    var _S8 : u32;
    if(bin_2 < u32(2))
    {
        _S8 = counters_0.x;
    }
    else
    {
        _S8 = counters_0.y;
    }
    return (((_S8 >> ((counterShift_0(bin_2))))) & (u32(65535)));
}

fn splitWords_0( thread_3 : u32,  bit_0 : u32)
{
    var mine_1 : array<u32, i32(8)>;
    var _S9 : vec2<u32> = vec2<u32>(vec2<i32>(i32(0)));
    var i_1 : u32 = u32(0);
    var counts_0 : vec2<u32> = _S9;
    for(;;)
    {
        if(i_1 < u32(8))
        {
        }
        else
        {
            break;
        }
        mine_1[i_1] = words_0[u32(8) * thread_3 + i_1];
        var counts_1 : vec2<u32> = counts_0 + counterOne_0(((((words_0[u32(8) * thread_3 + i_1]) >> (bit_0))) & (u32(3))));
        i_1 = i_1 + u32(1);
        counts_0 = counts_1;
    }
    var totals_1 : vec2<u32>;
    var _S10 : vec2<u32> = exclusiveScan_0(thread_3, counts_0, &(totals_1));
    var _S11 : vec2<u32> = _S10 + counterStarts_0(totals_1);
    i_1 = u32(0);
    var next_1 : vec2<u32> = _S11;
    for(;;)
    {
        if(i_1 < u32(8))
        {
        }
        else
        {
            break;
        }
        var bin_3 : u32 = ((((mine_1[i_1]) >> (bit_0))) & (u32(3)));
        words_0[counterOf_0(next_1, bin_3)] = mine_1[i_1];
        var next_2 : vec2<u32> = next_1 + counterOne_0(bin_3);
        i_1 = i_1 + u32(1);
        next_1 = next_2;
    }
    workgroupBarrier();
    return;
}

fn digitAt_0( place_0 : u32) -> u32
{
    return ((((words_0[place_0]) >> (u32(11)))) & (u32(255)));
}

fn sortedElement_0( word_0 : u32,  block_1 : u32) -> u32
{
    var element_1 : u32 = block_1 + ((word_0 & (u32(2047))));
    var upper_0 : u32 = (word_0 >> (u32(19)));
    var _S12 : u32;
    if((Constants_0.second_pass_0) != u32(0))
    {
        _S12 = (keys_0[element_1] & (u32(16777215)));
    }
    else
    {
        _S12 = (((upper_0 << (u32(24)))) | (element_1));
    }
    return _S12;
}

@compute
@workgroup_size(256, 1, 1)
fn ScatterDigits(@builtin(local_invocation_index) thread_4 : u32, @builtin(workgroup_id) group_0 : vec3<u32>)
{
    var _S13 : u32 = group_0.x;
    var block_2 : u32 = _S13 * u32(2048);
    var _S14 : u32 = loadWords_0(thread_4, block_2, elementCount_0());
    var total_4 : vec2<u32>;
    var _S15 : vec2<u32> = exclusiveScan_1(thread_4, vec2<u32>(digit_totals_0[thread_4], u32(0)), &(total_4));
    places_0[thread_4] = _S15.x;
    if(_S13 < (groupCount_0()))
    {
        places_0[thread_4] = places_0[thread_4] + digit_counts_0[thread_4 * groupCount_0() + _S13];
    }
    var _S16 : bool;
    if((Constants_0.second_pass_0) == u32(0))
    {
        _S16 = _S13 == u32(0);
    }
    else
    {
        _S16 = false;
    }
    if(_S16)
    {
        _S16 = thread_4 == u32(0);
    }
    else
    {
        _S16 = false;
    }
    if(_S16)
    {
        writeArguments_0(total_4.x);
    }
    workgroupBarrier();
    var bit_1 : u32 = u32(0);
    for(;;)
    {
        if(bit_1 < u32(8))
        {
        }
        else
        {
            break;
        }
        splitWords_0(thread_4, u32(11) + bit_1);
        bit_1 = bit_1 + u32(2);
    }
    var i_2 : u32 = thread_4;
    for(;;)
    {
        if(i_2 < _S14)
        {
        }
        else
        {
            break;
        }
        var digit_0 : u32 = digitAt_0(i_2);
        if(i_2 == u32(0))
        {
            _S16 = true;
        }
        else
        {
            _S16 = digit_0 != (digitAt_0(i_2 - u32(1)));
        }
        if(_S16)
        {
            places_0[digit_0] = places_0[digit_0] - i_2;
        }
        i_2 = i_2 + u32(256);
    }
    workgroupBarrier();
    i_2 = thread_4;
    for(;;)
    {
        if(i_2 < _S14)
        {
        }
        else
        {
            break;
        }
        sorted_0[places_0[digitAt_0(i_2)] + i_2] = sortedElement_0(words_0[i_2], block_2);
        i_2 = i_2 + u32(256);
    }
    return;
}

`,
};
