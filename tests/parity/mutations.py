"""One-line faults of the shaders, each of which the kernel's parity test must notice (test_mutations.py).

Not listed, because no image and no number shows them: reads past a tile's edge whose results are not written, and
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
    "dq_skinning": [
        Fault(
            "wrong sign of a dual quaternion", "dot(real, reference) < 0 ? -weight : weight", "weight", "common.hlsl"
        ),
        Fault("sign against the wrong joint", "joints[2 * indices[INFLUENCES * vertex]];", "joints[0];"),
        Fault(
            "what is turned half round subtracted",
            "dot(real, reference) < 0 ?",
            "dot(real, reference) <= 0 ?",
            "common.hlsl",
        ),
        Fault("dual part not normalised", "total.dual /= norm;", "", "common.hlsl"),
        Fault("last influence lost", "i < INFLUENCES * (vertex + 1)", "i + 1 < INFLUENCES * (vertex + 1)"),
        Fault("written past the last vertex", "if (vertex >= vertex_count)", "if (vertex > vertex_count)"),
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
    "splat_project": [
        Fault(
            "halves swapped in packing",
            "f32tof16(values.x) | (f32tof16(values.y) << 16)",
            "f32tof16(values.y) | (f32tof16(values.x) << 16)",
            "common.hlsl",
        ),
        Fault(
            "handedness of the quaternion product",
            "+ b.x * a.yzw + cross(a.yzw, b.yzw)",
            "+ b.x * a.yzw - cross(a.yzw, b.yzw)",
            "common.hlsl",
        ),
        Fault(
            "half of a dual quaternion's translation",
            "+ 2 * quaternionMultiply(dual,",
            "+ quaternionMultiply(dual,",
            "common.hlsl",
        ),
        Fault("sign against the wrong vertex", "if (barycentric.z > max(barycentric.x, barycentric.y))", "if (false)"),
        Fault(
            "barycentrics swapped", "float2(place.y & 0xffff, place.y >> 16)", "float2(place.y >> 16, place.y & 0xffff)"
        ),
        Fault("third barycentric", "max(1 - first.x - first.y, 0)", "max(1 - first.x, 0)"),
        Fault("channels read texel by texel", "row * texel_count + texel", "texel * 6 + row"),
        Fault("texel's axes not scaled", "exp(min(float3(turn.w, scale.xy), LARGEST_LOG_SCALE))", "1"),
        Fault("scale bounded to that of a room", "LARGEST_LOG_SCALE = 10", "LARGEST_LOG_SCALE = 3"),
        Fault("scale not bounded", "min(float3(turn.w, scale.xy), LARGEST_LOG_SCALE)", "float3(turn.w, scale.xy)"),
        Fault("rotations in the wrong order", "quaternionMultiply(dq.real, own)", "quaternionMultiply(own, dq.real)"),
        Fault("opacity inverted", "logit < 0 ? small : 1", "logit < 0 ? 1 : small"),
        Fault("wrong entry of a rotation", "xz + turns.y", "xz - turns.y"),
        Fault("two-sided texels not drawn from behind", "if (place.x >= ONE_SIDED)", "if (true)"),
        Fault("one-sided texels drawn from behind", "if (place.x >= ONE_SIDED)", "if (false)"),
        Fault("mark in place of the triangle", "place.x & ~ONE_SIDED", "place.x & ONE_SIDED"),
        Fault("front taken for back", "cross(at[1] - at[0], at[2] - at[0])", "cross(at[2] - at[0], at[1] - at[0])"),
        Fault(
            "normal of the bind pose",
            "quaternionRotate(dq.real, cross(at[1] - at[0], at[2] - at[0]))",
            "cross(at[1] - at[0], at[2] - at[0])",
        ),
        Fault("not drawn where a triangle is seen edge-on", "> AWAY *", "> 0 *"),
        Fault(
            "distance left out where triangles are seen from behind", "length(normal) * length(place)", "length(normal)"
        ),
        Fault("second eye sees the back as the first does", "isBehind(gaussian, eyes - 1)", "isBehind(gaussian, 0)"),
        Fault("missing near-plane test", "-place.z > near ?", "true ?"),
        Fault("key inverted", "saturate((farthest - depth)", "saturate((depth - nearest)"),
        Fault("15-bit key", "LAST_KEY = 0xfffe", "LAST_KEY = 0x7fff"),
        Fault(
            "second eye has the first one's view",
            "mul(view[eye], float4(gaussian.centre, 1))",
            "mul(view[0], float4(gaussian.centre, 1))",
        ),
        Fault("depth of the first eye alone", "depthOf = 0.5 * (depthOf - view[1][2]);", ";"),
        Fault("rows run up", "float2(1, -1); // rows run down", "float2(1, 1); // rows run down"),
        Fault("linearisation not held at the screen's edge", "clamp(ndc, -GUARD, GUARD)", "ndc"),
        Fault("wrong row of the Jacobian", "row.z * gaussian.rows[2]", "row.z * gaussian.rows[1]"),
        Fault("transparent splats kept", " && opacity >= LEAST_OPACITY", ""),
        Fault(
            "ellipse of the unseeing eye", "isBehind(gaussian, eyes - 1) || !isSeen(second, gaussian.opacity)", "false"
        ),
        Fault("axis as long as one", "min(ellipse.deviations.x, LARGEST_HALF) * ellipse.axis", "ellipse.axis"),
        Fault(
            "eyes swapped in packing", "packedAxis(first), packedAxis(second)", "packedAxis(second), packedAxis(first)"
        ),
        Fault("second key of a word lost", "groupKeys[pair] | (groupKeys[pair + 1] << 16)", "groupKeys[pair]"),
        Fault("keys of the first group", "(first_splat + THREADS * group.x) / 2 + place", "first_splat / 2 + place"),
        Fault(
            "keys of another avatar", "(first_splat + THREADS * group.x) / 2 + place", "THREADS * group.x / 2 + place"
        ),
        Fault("splats of another avatar", "2 * (first_splat + texel)", "2 * texel"),
        Fault("written past the last texel", "if (thread.x < texel_count)", "if (thread.x <= texel_count)"),
        Fault(
            "dropped barrier before keys are packed", "GroupMemoryBarrierWithGroupSync();\n    uint pair", "uint pair"
        ),
        Fault(
            "R_tex not conjugated",
            "quaternionRotate(quaternionConjugate(rotation), direction)",
            "quaternionRotate(rotation, direction)",
            "splat_draw.hlsl",
        ),
        Fault(
            "order of the SH coefficients",
            "direction.z * sh[2] - direction.y * sh[1]",
            "direction.z * sh[1] - direction.y * sh[2]",
            "splat_draw.hlsl",
        ),
        Fault("second eye's colour that of the first", "eyePosition(1))", "eyePosition(0))"),
        Fault("position of an eye not turned", "-toEye[0].w * toEye[0].xyz", "-toEye[0].w * toEye[1].xyz"),
        Fault("tints of the wrong sign", "0.5 * (first - second)", "0.5 * (second - first)"),
        Fault("scale that does not hold the tint", "max(mean, abs(tint) *", "max(mean, 0 * abs(tint) *"),
        Fault("tint not bounded", "clamp(tint * steps, -most, most)", "tint * steps"),
        Fault("scale of the next colours", "largest > 1 ? 1 : 0", "largest > 2 ? 1 : 0"),
        Fault("colours cut off", "min(mean * steps, COLOR_STEPS) + 0.5", "min(mean * steps, COLOR_STEPS)"),
        Fault("opacity cut off", "uint(opacity * OPACITY_STEPS + 0.5)", "uint(opacity * OPACITY_STEPS)"),
        Fault("green and blue swapped", "(tints.y << 18) | (tints.z << 25)", "(tints.z << 18) | (tints.y << 25)"),
        drawn("box of the lesser half width", "(size.x + size.y) * size", "0 * size"),
    ],
    "splat_sort": [
        Fault(
            "sum of the row itself in the scan of a row",
            "scanned[place] = sum;\n        sum += next;",
            "sum += next;\n        scanned[place] = sum;",
            "scan.hlsl",
        ),
        Fault(
            "rows not added to in the scan of a group",
            "scanned[scanPlace(thread)] + rowStarts[thread / SCAN_ROW]",
            "scanned[scanPlace(thread)]",
            "scan.hlsl",
        ),
        Fault(
            "dropped barrier between threads and rows of a scan",
            "scanned[scanPlace(thread)] = value;\n    GroupMemoryBarrierWithGroupSync();",
            "scanned[scanPlace(thread)] = value;",
            "scan.hlsl",
        ),
        Fault("keys of a word swapped", "wordOf(pair & 0xffff,", "wordOf(pair >> 16,"),
        Fault("hidden keys sorted", "key == HIDDEN ? NOTHING :", "key == NOTHING ? NOTHING :"),
        Fault("key past the last of the first pass", "element + 1 < count", "element + 1 <= count"),
        Fault("element past the last of the second pass", "block + place + i < count", "block + place + i <= count"),
        Fault("upper digit lost", "((word >> UPPER_BIT) & 0xff) << INDEX_BITS", "0"),
        Fault("upper digit left in the order", "word & ((1u << INDEX_BITS) - 1)", "word"),
        Fault("index in the first block", "block + (word & (BLOCK - 1))", "(word & (BLOCK - 1))"),
        Fault("digits of the first pass by the second", "(key & 0xff) << DIGIT_BIT", "(key >> 8) << DIGIT_BIT"),
        Fault("unstable split", "+ ranks[i]] = mine[i]", "+ 7 - ranks[i]] = mine[i]"),
        Fault("odd bins as even ones", "counts.x, counts.x >> 4,", "counts.x, counts.x,"),
        Fault("upper bins as lower ones", "bin < 8 ? bytes.xy : bytes.zw", "bytes.xy"),
        Fault(
            "row of threads begins anew at each",
            "writeCounters(place, sum);\n        sum",
            "writeCounters(place, 0);\n        sum",
        ),
        Fault("row's own counters lost", "if (thread < ROWS)\n        writeCounters(place, sum);", ""),
        Fault(
            "components of counters over each other",
            "words[COUNTERS * k + place] = bytes[k];",
            "words[place] = bytes[k];",
        ),
        Fault(
            "counters over words that are still read",
            "words[EACH * thread + i] : NOTHING;\n    GroupMemoryBarrierWithGroupSync();",
            "words[EACH * thread + i] : NOTHING;",
        ),
        Fault("rows of a bin mixed up", "(ROW + 1) * bin + thread / ROW]", "(ROW + 1) * bin]"),
        Fault("later split forgets what is left", "EACH * thread + i < live ?", "EACH * thread + i < BLOCK ?"),
        Fault(
            "groups of the second pass not by what is left",
            "second_pass != 0 ? arguments[COUNT_WORD] : key_count",
            "max(arguments[COUNT_WORD], key_count)",
        ),
        Fault(
            "off by one in the scan of the digits",
            "digit_counts[row + i] = before;",
            "digit_counts[row + i] = before + count;",
        ),
        Fault(
            "dropped barrier between the runs of a digit",
            "sums[thread] = sum;\n    GroupMemoryBarrierWithGroupSync();",
            "sums[thread] = sum;",
        ),
        Fault("total without the last run", "digit_totals[digit] = before + sum;", "digit_totals[digit] = before;"),
        Fault("smaller digits not counted", "exclusiveScan(thread, digits - mine, total) + earlier", "earlier - mine"),
        Fault("rank of the block not subtracted", "digits - mine, total", "digits, total"),
        Fault(
            "elements of the last group by the next digit's first",
            "group + 1 < groups ? digit_counts[row + group + 1] : digits",
            "digit_counts[row + group + 1]",
        ),
        Fault("last split of a digit lost", "live = splitWords(thread, mine, DIGIT_BIT + SPLIT_BITS);", ""),
        Fault("vertices of a draw not counted", "corners * total", "total"),
        Fault(
            "arguments written by the second pass",
            "second_pass == 0 && group.x == 0",
            "second_pass != 0 && group.x == 0",
        ),
    ],
    "splat_draw": [
        drawn("eye index ignored", "eye == 0 ? tail.y : tail.z", "tail.y"),
        drawn("tints of the other eye", "eye == 0 ? tint : -tint", "eye == 0 ? -tint : tint"),
        drawn("one scale for all colours", "float(1u << exponent)", "1.0"),
        drawn("opacity of ten bits", "OPACITY_STEPS = 2047", "OPACITY_STEPS = 1023"),
        drawn("vertex of the neighbouring splat", "order[place]", "order[place + 1]"),
        drawn(
            "ellipse turned the wrong way",
            "dot(axis, corner) * axis",
            "dot(axis, corner) * axis.yx",
        ),
        drawn("pixels run up", "pixels * float2(2, -2) / screen", "pixels * 2 / screen"),
        drawn("depth inverted", "clamp(clip.z / clip.w", "clamp(clip.w / clip.z"),
        drawn("pixel not integrated over", "PIXEL_VARIANCE = 5.0 / 12.0", "PIXEL_VARIANCE = 1e-6"),
        drawn("variance of the pixel alone", "PIXEL_VARIANCE = 5.0 / 12.0", "PIXEL_VARIANCE = 1.0 / 3.0"),
        drawn("peak not lowered", "color.a * splatShare(deviations, wide)", "color.a * WEIGHT"),
        drawn("integral of the window alone", "WEIGHT = 1.125 *", "WEIGHT = 1.27 *"),
        drawn("wider than it is", "static const float REACH = 2.015", "static const float REACH = 2.2"),
        drawn("no window across", "window.x * window.y", "window.x"),
        drawn("window of a cone", "1 - varyings.offset * varyings.offset", "1 - abs(varyings.offset)"),
        drawn("not premultiplied", "SHADE4(varyings.color.rgb * alpha, alpha)", "SHADE4(varyings.color.rgb, alpha)"),
    ],
}
