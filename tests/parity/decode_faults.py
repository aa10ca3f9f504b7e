"""Faults of the kernels that decode an avatar: from a pose to the channels of its texels."""

from fault import Fault

DECODING = {
    "mlp_matmul": [
        Fault(
            "wrong half of a packed f16 word",
            "f16tof32((word >> (16 * lane)) & 0xffff)",
            "f16tof32((word >> (16 - 16 * lane)) & 0xffff)",
            file="common.hlsl",
        ),
        Fault(
            "i8 without sign extension",
            "int(word << (24 - 8 * lane)) >> 24",
            "int((word >> (8 * lane)) & 0xff)",
            file="common.hlsl",
        ),
        Fault(
            "i8 without its scale", " * asfloat(words[tensorLayout.z + index / tensorLayout.y])", "", file="common.hlsl"
        ),
        Fault(
            "scale of the neighbouring row",
            "tensorLayout.z + index / tensorLayout.y",
            "tensorLayout.z + (index + 1) / tensorLayout.y",
            file="common.hlsl",
        ),
        Fault(
            "dropped barrier of the reduction",
            "partialSums[slot + reach];\n        GroupMemoryBarrierWithGroupSync();",
            "partialSums[slot + reach];",
        ),
        Fault("ReLU lost", "max(value, 0)", "value"),
        Fault("last column of a row lost", "column < inputs; column += LANES", "column + 1 < inputs; column += LANES"),
        Fault("read past the end of a row", "column < inputs; column += LANES", "column <= inputs; column += LANES"),
        Fault("write past the last row", "bool live = row < outputs;", "bool live = row <= outputs;"),
        Fault("PCA basis read by columns", "row * outputs + column", "column * inputs + row"),
        Fault(
            "mean of the PCA mesh subtracted",
            "sum + stored(bias, bias_layout, column)",
            "sum - stored(bias, bias_layout, column)",
        ),
        Fault("write past the last vertex", "if (column >= outputs)", "if (column > outputs)"),
    ],
    "blend_subbands": [
        Fault("LL reads the first coefficients", "alpha[alpha_offset + map]", "alpha[map]"),
        Fault("D3 reads the coefficients of LL", "alpha[alpha_offset + channel * rank +", "alpha[channel * rank +"),
        Fault("bands and channels swapped", "plane % channels", "plane / 3"),
        Fault(
            "h by columns",
            "factor(h, h_layout, plane, r, corner.y + position)",
            "factor(h, h_layout, plane, r, corner.x + position)",
        ),
        Fault("w by rows", "uint column = k * TILE + 2 * thread.x;", "uint column = k * TILE + 2 * thread.y;"),
        Fault("read past the rank", "if (r < rank && position < size)", "if (position < size)"),
        Fault("write past the side", "if (at.x < size && at.y < size)", "if (at.y < size)"),
        Fault(
            "dropped barrier before a tile is read",
            "GroupMemoryBarrierWithGroupSync();\n        [unroll]\n        for (uint k",
            "[unroll]\n        for (uint k",
        ),
        Fault(
            "dropped barrier before a tile is overwritten",
            "across;\n        }\n        GroupMemoryBarrierWithGroupSync();",
            "across;\n        }",
        ),
    ],
    "inverse_dwt": [
        Fault(
            "columns held at the edge, not periodic",
            "return (sample == 0 ? size : sample) - 1;",
            "return max(sample, 1) - 1;",
        ),
        Fault("rows off by one round the edge", "- (taps / 2 - 1)) % size;", "- (taps / 2 - 1)) % (size + 1);"),
        Fault(
            "fine samples not wrapped",
            "taps * size - (taps / 2 - 1)) % side;",
            "taps * size - (taps / 2 - 1)) % (2 * side);",
        ),
        Fault("halves of a word swapped", "column & 1);", "~column & 1);"),
        Fault(
            "rows without their padding",
            "(planes * size + row) * rowWords(size);",
            "(planes * size + row) * (size / 2);",
        ),
        Fault(
            "wrong phase of the taps",
            "float2(filter[2 * j], filter[2 * j + 1])",
            "float2(filter[2 * j + 1], filter[2 * j])",
        ),
        Fault(
            "swapped bands",
            "filterRow(details, channels + id.z, row, rec_hi, id.x)",
            "filterRow(details, id.z, row, rec_hi, id.x)",
        ),
        Fault(
            "low-pass filter on the diagonal band",
            "filterRow(details, 2 * channels + id.z, row, rec_hi, id.x)",
            "filterRow(details, 2 * channels + id.z, row, rec_lo, id.x)",
        ),
        Fault(
            "low-pass filter on the rows' high-pass part",
            "low + filterColumns(rec_hi, thread.xy)",
            "low + filterColumns(rec_lo, thread.xy)",
        ),
        Fault(
            "rows and columns of a square swapped",
            "packBounded(square.xy)",
            "packBounded(square.xz)",
        ),
        Fault("write past the side", "if (coarse.x >= size || coarse.y >= size)", "if (coarse.y >= size)"),
        Fault(
            "dropped barrier before the low-pass part's columns",
            "GroupMemoryBarrierWithGroupSync();\n    float4 low",
            "float4 low",
        ),
        Fault(
            "high-pass part over the low-pass one that is still read",
            "filterColumns(rec_lo, thread.xy);\n    GroupMemoryBarrierWithGroupSync();",
            "filterColumns(rec_lo, thread.xy);",
        ),
        Fault(
            "dropped barrier before the high-pass part's columns",
            "GroupMemoryBarrierWithGroupSync();\n    writeSquare",
            "writeSquare",
        ),
        Fault(
            "dropped barrier before the texels",
            "GroupMemoryBarrierWithGroupSync();\n\n    uint2 run",
            "uint2 run",
        ),
        Fault("tile's row for its column", "tiles[group.x] & 0xffff, tiles[group.x] >> 16", "tiles[group.x] >> 16, 0"),
        Fault("rows of ll off by one", "reach * size - (reach - 1)) % size", "reach * size - reach) % size"),
        Fault("wrong phase of a texel", "(position + delay) % factor", "position % factor"),
        Fault("filter not delayed", "(position + delay) / factor", "position / factor"),
        Fault("last sample left out", "tap += factor;", "tap += factor; j += j + 2 == reach ? 1 : 0;"),
        Fault("written past the last channel", "if (first + i < channels)", "if (first + i <= channels)"),
        Fault(
            "half floats of a texel swapped",
            "packBounded(whole.xy), packBounded(whole.zw)",
            "packBounded(whole.zw), packBounded(whole.xy)",
        ),
        Fault("texels without a splat written", "if ((run.y >> thread.x & 1) == 0)", "if (run.y == 0)"),
        Fault("texels of a row counted with their own", "((1u << thread.x) - 1)", "((2u << thread.x) - 1)"),
        Fault("appearance written over geometry", "first_row + first / BATCH", "first / BATCH"),
        Fault("static offset subtracted", "values[i] + stored(", "values[i] - stored("),
        Fault(
            "static offset of another channel", "(first + i) * texel_count + texel);", "first * texel_count + texel);"
        ),
    ],
    "expressions": [
        Fault("first expression for all", "weights[expressions[i]]", "weights[expressions[0]]"),
        Fault("last entry lost", "i < starts[thread.x + 1]", "i + 1 < starts[thread.x + 1]"),
        Fault("vertices moved half way", "mesh[vertex + k] += sum[k];", "mesh[vertex + k] += sum[k] / 2;"),
        Fault("moved by as much again", "moved[vertex + k] = sum[k];", "moved[vertex + k] += sum[k];"),
        Fault("written past the last vertex", "if (thread.x >= vertex_count)", "if (thread.x > vertex_count)"),
        Fault("written past the last triangle", "if (thread.x >= triangle_count)", "if (thread.x > triangle_count)"),
        Fault("written past the last texel", "if (thread.x >= texel_count)", "if (thread.x > texel_count)"),
        Fault("triangles out of reach", "3 * triangles[thread.x]", "3 * triangles[0]"),
        Fault("texels out of reach", "uint texel = reached[thread.x].x;", "uint texel = thread.x;"),
        Fault("another triangle's bend", "4 * reached[thread.x].y;", "4 * thread.x;"),
        Fault("a corner that moves missed", " || any(far[2] != 0);", ";"),
        Fault("triangles that vanish", " || !holds(after)", ""),
        Fault("triangles out of nothing", " || !holds(before)", ""),
        Fault("turned the other way", "float2(along + height, -shear)", "float2(along + height, shear)"),
        Fault("shear lost", "(after.shear - along * before.shear)", "0 * (after.shear - along * before.shear)"),
        Fault("stretched inversely", "after.height / before.height", "before.height / after.height"),
        Fault("thickness lost", "stretched + before.normal[i] * after.normal", "stretched"),
        Fault("half turns about another axis", "- z.z, y.z + z.y", "- z.z, y.z - z.y"),
        Fault("sign of a turn", "y.z - z.y, z.x - x.z", "z.y - y.z, z.x - x.z"),
        Fault("turned half round", "(found.x < 0 ? -1 : 1) *", "2 *"),
        Fault("stretch without bound", "clamp(length(stretched), 1 / MOST_STRETCH, MOST_STRETCH)", "length(stretched)"),
        Fault("scales of another axis", "quaternionRotate(unit, ends[k])", "quaternionRotate(unit, ends[2 - k])"),
        Fault("rotation of any length stretched", "quaternionRotate(unit,", "quaternionRotate(rotation,"),
        Fault("offset not turned", "quaternionRotate(turn, offset)", "offset"),
        Fault("rotations in the wrong order", "Multiply(turn, rotation)", "Multiply(rotation, turn)"),
        Fault("opacity lost", "uint2(packBounded(scale.yz), words[2].y)", "uint2(packBounded(scale.yz), 0)"),
    ],
}
