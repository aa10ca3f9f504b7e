// What several kernels share: elements of stored tensors, half floats in pairs, quaternions, dual quaternions, their blend.
// References: python/mua/asset/tensors.py, python/mua/rotation.py.

#ifndef MUA_COMMON_HLSL
#define MUA_COMMON_HLSL

// Element types of stored tensors, as in schemas/muaavatar.fbs; the third is I8.
static const uint STORED_F32 = 0;
static const uint STORED_F16 = 1;

static const float LARGEST_HALF = 65504;
static const float LEAST_NORM = 1.17549435e-38; // the smallest normal float: rotations that cancel stay finite

// The half float in the low half of a word (lane 0) or in its high half (lane 1).
float halfAt(uint word, uint lane)
{
    return f16tof32((word >> (16 * lane)) & 0xffff);
}

// The signed byte of a word, lane 0 (lowest) to 3, before its scale.
int byteAt(uint word, uint lane)
{
    return int(word << (24 - 8 * lane)) >> 24;
}

// Element `index` of a stored tensor.
// tensorLayout = (element type, elements for each scale, index of the first scale's word).
float stored(StructuredBuffer<uint> words, uint3 tensorLayout, uint index)
{
    uint word = words[index >> tensorLayout.x]; // of 1, 2 or 4 elements: 2 to the power of the element type
    uint lane = index & ((1u << tensorLayout.x) - 1);
    float value = 0;
    if (tensorLayout.x == STORED_F32)
        value = asfloat(word | lane); // lane is 0, and the word an integer on every device: README.md
    else if (tensorLayout.x == STORED_F16)
        value = halfAt(word, lane);
    else
        value = byteAt(word, lane) * asfloat(words[tensorLayout.z + index / tensorLayout.y]);
    return value;
}

// Two half floats in one word, values.x in its low half.
uint packHalves(float2 values)
{
    return f32tof16(values.x) | (f32tof16(values.y) << 16);
}

// Two half floats in a word, clamped to the largest half float.
uint packBounded(float2 values)
{
    return packHalves(clamp(values, -LARGEST_HALF, LARGEST_HALF));
}

float2 unpackHalves(uint word)
{
    return float2(halfAt(word, 0), halfAt(word, 1));
}

// Planes of half floats that follow each other: each row is whole words, two columns to a word, the last padded.
uint rowWords(uint size)
{
    return (size + 1) / 2;
}

// Quaternions are float4(w, x, y, z).

// Hamilton product: the rotation b, then a.
float4 quaternionMultiply(float4 a, float4 b)
{
    return float4(a.x * b.x - dot(a.yzw, b.yzw), a.x * b.yzw + b.x * a.yzw + cross(a.yzw, b.yzw));
}

float4 quaternionConjugate(float4 q)
{
    return float4(q.x, -q.yzw);
}

// A vector turned by a unit quaternion.
float3 quaternionRotate(float4 q, float3 v)
{
    float3 t = 2 * cross(q.yzw, v);
    return v + q.x * t + cross(q.yzw, t);
}

// A point moved by a unit dual quaternion: real = rotation, dual = 0.5 (0, translation) rotation.
float3 dualTransform(float4 real, float4 dual, float3 p)
{
    return quaternionRotate(real, p) + 2 * quaternionMultiply(dual, quaternionConjugate(real)).yzw;
}

struct DualQuaternion
{
    float4 real;
    float4 dual;
};

DualQuaternion noTransform()
{
    DualQuaternion none;
    none.real = 0;
    none.dual = 0;
    return none;
}

// Add weight x (real, dual) on the hemisphere of the reference.
DualQuaternion accumulate(DualQuaternion total, float4 real, float4 dual, float weight, float4 reference)
{
    float signedWeight = dot(real, reference) < 0 ? -weight : weight;
    total.real += signedWeight * real;
    total.dual += signedWeight * dual;
    return total;
}

// A sum divided by the norm of its real part, without orthogonalisation.
DualQuaternion normalized(DualQuaternion total)
{
    float norm = max(length(total.real), LEAST_NORM);
    total.real /= norm;
    total.dual /= norm;
    return total;
}

#endif
