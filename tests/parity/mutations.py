"""One-line faults of the shaders, each of which the kernel's parity test must notice (test_mutations.py).

Not listed, because no picture and no number shows them: reads past a tile's edge whose results are not written, and
quads drawn for an eye that does not see the splat, whose deviations of 0 leave them without opacity.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Fault:
    """What is wrong once `original`, which stands once in the file, reads `replacement`."""

    breaks: str
    original: str
    replacement: str
    file: str = ""  # the kernel's own if empty


def drawn(breaks: str, original: str, replacement: str) -> Fault:
    """A fault in what is drawn."""
    return Fault(breaks, original, replacement, file="splat_draw.hlsl")


FAULTS = {
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
        Fault("w by rows", "uint column = k * TILE + thread.x;", "uint column = k * TILE + thread.y;"),
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
        Fault("fine samples not wrapped", "(near + 1) % side", "near + 1"),
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
            "filterColumns(HIGH, rec_hi, thread.xy)",
            "filterColumns(HIGH, rec_lo, thread.xy)",
        ),
        Fault(
            "rows and columns of a square swapped",
            "fine[rows.x + far.x] = square.y;",
            "fine[rows.x + far.x] = square.z;",
        ),
        Fault("write past the side", "if (coarse.x >= size || coarse.y >= size)", "if (coarse.y >= size)"),
        Fault(
            "dropped barrier",
            "GroupMemoryBarrierWithGroupSync();\n    writeSquare(id, filterColumns(LOW, rec_lo, thread.xy) +",
            "writeSquare(id, filterColumns(LOW, rec_lo, thread.xy) +",
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
    "dq_skinning": [
        Fault(
            "halves swapped in packing",
            "f32tof16(values.x) | (f32tof16(values.y) << 16)",
            "f32tof16(values.y) | (f32tof16(values.x) << 16)",
            file="common.hlsl",
        ),
        Fault(
            "handedness of the quaternion product",
            "+ b.x * a.yzw + cross(a.yzw, b.yzw)",
            "+ b.x * a.yzw - cross(a.yzw, b.yzw)",
            file="common.hlsl",
        ),
        Fault(
            "half of a dual quaternion's translation",
            "+ 2 * quaternionMultiply(dual,",
            "+ quaternionMultiply(dual,",
            file="common.hlsl",
        ),
        Fault("wrong sign of a dual quaternion", "dot(real, reference) < 0 ? -weight : weight", "weight"),
        Fault("sign against the wrong joint", "joints[2 * indices[INFLUENCES * vertex]];", "joints[0];"),
        Fault("sign against the wrong vertex", "if (barycentric.z > max(barycentric.x, barycentric.y))", "if (false)"),
        Fault("dual part not normalised", "total.dual /= norm;", ""),
        Fault("last influence lost", "i < INFLUENCES * (vertex + 1)", "i + 1 < INFLUENCES * (vertex + 1)"),
        Fault("third barycentric", "max(1 - first.x - first.y, 0)", "max(1 - first.x, 0)"),
        Fault("channels read texel by texel", "row * texel_count + texel", "texel * 6 + row"),
        Fault(
            "wrong covariance entry",
            "dot(rows[1], rows[2]), dot(rows[2], rows[2])",
            "dot(rows[0], rows[2]), dot(rows[2], rows[2])",
        ),
        Fault("scale not exponentiated", "exp(logScale)", "logScale"),
        Fault(
            "scale not bounded", "min(float3(second4.w, third4.xy), LARGEST_LOG_SCALE)", "float3(second4.w, third4.xy)"
        ),
        Fault("rotations in the wrong order", "quaternionMultiply(dq.real, own)", "quaternionMultiply(own, dq.real)"),
        Fault("opacity inverted", "logit < 0 ? small : 1", "logit < 0 ? 1 : small"),
        Fault(
            "order of the SH coefficients",
            "uint4(texel_channels[sh], texel_channels[sh + texel_count])",
            "uint4(texel_channels[sh + texel_count], texel_channels[sh])",
        ),
    ],
    "splat_project": [
        Fault("missing near-plane test", "-place.z > near ?", "true ?"),
        Fault("key inverted", "saturate((farthest - depth)", "saturate((depth - nearest)"),
        Fault("15-bit key", "LAST_KEY = 0xffff", "LAST_KEY = 0x7fff"),
        Fault(
            "second eye has the first one's view",
            "mul(view[eye], float4(centre, 1))",
            "mul(view[0], float4(centre, 1))",
        ),
        Fault("depth of the first eye alone", "depthOf = 0.5 * (depthOf - view[1][2]);", ";"),
        Fault("rows run up", "float2(1, -1); // rows run down", "float2(1, 1); // rows run down"),
        Fault("linearisation not held at the screen's edge", "clamp(ndc, -GUARD, GUARD)", "ndc"),
        Fault("wrong covariance entry", "dot(float3(xs.z, yz.yz), v)", "dot(float3(xs.y, yz.yz), v)"),
        Fault("transparent splats kept", " && opacity >= LEAST_OPACITY", ""),
        Fault("deviations of the unseeing eye", "seen ? ellipse.deviations : 0", "ellipse.deviations"),
        Fault("off by one in the scan of the groups", "group_counts[j] = before;", "group_counts[j] = before + count;"),
        Fault(
            "groups of the sort rounded down", "(total + KEYS_PER_GROUP - 1) / KEYS_PER_GROUP", "total / KEYS_PER_GROUP"
        ),
        Fault(
            "groups compacted over each other",
            "group_counts[group.x] + exclusiveScan",
            "group_counts[0] + exclusiveScan",
        ),
        Fault("off by one in the scan of a group", "if (thread >= reach)", "if (thread > reach)", file="scan.hlsl"),
        Fault(
            "R_tex not conjugated",
            "quaternionRotate(quaternionConjugate(rotation), direction)",
            "quaternionRotate(rotation, direction)",
            file="splat_draw.hlsl",
        ),
        Fault(
            "order of the SH coefficients",
            "direction.z * sh[2] - direction.y * sh[1]",
            "direction.z * sh[1] - direction.y * sh[2]",
            file="splat_draw.hlsl",
        ),
        Fault(
            "half a pixel of the quad lost", "deviations * reach + 0.5", "deviations * reach", file="splat_draw.hlsl"
        ),
    ],
    "splat_sort": [
        Fault(
            "dropped barrier between read and write of a scan",
            "sum += scanned[thread - reach];\n        GroupMemoryBarrierWithGroupSync();",
            "sum += scanned[thread - reach];",
            file="scan.hlsl",
        ),
        Fault(
            "count of the wrong digit",
            "(keys[element] >> shift) & (DIGITS - 1)",
            "(keys[element] >> (8 - shift)) & (DIGITS - 1)",
        ),
        Fault("wrong digit shift", ">> (BLOCK_BITS + shift)) & (DIGITS - 1)", ">> BLOCK_BITS) & (DIGITS - 1)"),
        Fault("count past the last key", "if (element < count)", "if (element <= count)"),
        Fault("unstable split", "mine[i] = words[EACH * thread + i];", "mine[i] = words[THREADS * i + thread];"),
        Fault("missing keys come first", "i < live ? keys[block + i] : LAST_KEY", "i < live ? keys[block + i] : 0"),
        Fault(
            "off by one in the scan of the digits",
            "digit_counts[row + i] = before;",
            "digit_counts[row + i] = before + count;",
        ),
        Fault("smaller digits not counted", "places[thread] = smaller + digit_counts", "places[thread] = digit_counts"),
        Fault("rank of the block not subtracted", "places[digit] -= i;", "places[digit] -= 0;"),
        Fault(
            "last split of a digit lost",
            "bit < DIGIT_BITS; bit += SPLIT_BITS",
            "bit + SPLIT_BITS < DIGIT_BITS; bit += SPLIT_BITS",
        ),
        Fault("values of the first block", "values[block + (word & (BLOCK - 1))]", "values[word & (BLOCK - 1)]"),
    ],
    "splat_draw": [
        drawn("missing clamp of alpha", "min(varyings.color.a * integral, MOST_ALPHA)", "varyings.color.a * integral"),
        drawn("eye index ignored", "(eye * splatCount + splat) * 3", "splat * 3"),
        drawn("vertex of the neighbouring splat", "order[vertex / 6]", "order[(vertex + 1) / 6]"),
        drawn(
            "ellipse turned the wrong way",
            "axis.x * offset.x - axis.y * offset.y",
            "axis.x * offset.x + axis.y * offset.y",
        ),
        drawn("pixels run up", "1 - 2 * pixel.y / screen.y", "2 * pixel.y / screen.y - 1"),
        drawn("depth inverted", "clamp(clip.z / clip.w", "clamp(clip.w / clip.z"),
        drawn("cubic term of the mass lost", "1.6 + 0.07 * right * right", "1.6"),
        drawn("half a pixel of the mass lost", "(offset + 0.5) / deviations", "offset / deviations"),
        drawn("not premultiplied", "float4(varyings.color.rgb * alpha, alpha)", "float4(varyings.color.rgb, alpha)"),
    ],
}
