"""Faults of the kernels that pose splats, sort and draw them.

Not listed, because no image and no number shows them: quads drawn for an eye that does not see the splat, whose
deviations of 0 leave them without opacity.
"""

from fault import Fault


def drawn(breaks: str, original: str, replacement: str) -> Fault:
    """A fault in what is drawn."""
    return Fault(breaks, original, replacement, file="splat_draw.hlsl")


SPLATS = {
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
