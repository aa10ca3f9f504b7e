// How a triangle bends: F = R P takes its two edges to the bent ones, and its unit normal to the bent one.
//
// Reference: python/mua/kernels/expressions.py

#ifndef MUA_BEND_HLSL
#define MUA_BEND_HLSL

static const float LEAST = 1e-5; // metres: a triangle with an edge or a height below it has no frame and no area

// A triangle a, b, c in axes of its own, where b - a = (along, 0, 0) and c - a = (shear, height, 0).
struct Frame
{
    float3 x;
    float3 y;
    float3 normal;
    float along;
    float shear;
    float height;
};

struct Bend
{
    float4 turn; // a quaternion of any length
    float3 diagonal; // of P: xx, yy, zz
    float3 others; // xy, xz, yz
    float2 own; // of a triangle or of a vertex: expressions.compute
};

Frame frameOf(float3 a, float3 b, float3 c)
{
    Frame frame;
    frame.along = length(b - a);
    frame.x = (b - a) / max(frame.along, LEAST);
    frame.shear = dot(frame.x, c - a);
    float3 across = c - a - frame.shear * frame.x;
    frame.height = length(across);
    frame.y = across / max(frame.height, LEAST);
    frame.normal = cross(frame.x, frame.y);
    return frame;
}

bool holds(Frame frame)
{
    return frame.along >= LEAST && frame.height >= LEAST;
}

// The unit quaternion, w 0 or more, of a rotation with these columns: of four formulas the one that divides by most.
float4 quaternionOf(float3 x, float3 y, float3 z)
{
    float4 found = float4(1 + x.x + y.y + z.z, y.z - z.y, z.x - x.z, x.y - y.x);
    float most = found.x;
    float4 other = float4(y.z - z.y, 1 + x.x - y.y - z.z, x.y + y.x, x.z + z.x);
    if (other.y > most)
        found = other;
    most = max(most, other.y);
    other = float4(z.x - x.z, x.y + y.x, 1 - x.x + y.y - z.z, y.z + z.y);
    if (other.z > most)
        found = other;
    most = max(most, other.z);
    other = float4(x.y - y.x, x.z + z.x, y.z + z.y, 1 - x.x - y.y + z.z);
    if (other.w > most)
        found = other;
    return (found.x < 0 ? -1 : 1) * found / length(found);
}

Bend noBend()
{
    Bend bend;
    bend.turn = float4(1, 0, 0, 0);
    bend.diagonal = 1;
    bend.others = 0;
    bend.own = 0;
    return bend;
}

// R and P of the map from one triangle to another.
Bend polar(Frame before, Frame after)
{
    float along = after.along / before.along; // the in-plane map, (along, shear; 0, height)
    float shear = (after.shear - along * before.shear) / before.height;
    float height = after.height / before.height;
    float2 turn = float2(along + height, -shear) / length(float2(along + height, shear)); // its polar rotation
    float3 x = turn.x * after.x + turn.y * after.y;
    float3 y = turn.x * after.y - turn.y * after.x;
    float3 turned[3];
    [unroll]
    for (uint i = 0; i < 3; i++)
        turned[i] = before.x[i] * x + before.y[i] * y + before.normal[i] * after.normal;
    Bend bend;
    bend.turn = quaternionOf(turned[0], turned[1], turned[2]);
    x = turn.x * along * before.x + (turn.x * shear + turn.y * height) * before.y; // P's columns, in the triangle's axes
    y = (turn.x * shear + turn.y * height) * before.x + (turn.x * height - turn.y * shear) * before.y;
    bend.diagonal = x * before.x + y * before.y + before.normal * before.normal;
    bend.others = x.xxy * before.x.yzz + y.xxy * before.y.yzz + before.normal.xxy * before.normal.yzz;
    bend.own = 0;
    return bend;
}

#endif
