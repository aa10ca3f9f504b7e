// Posed surfaces and what stands around them: shared by the desktop player's shaders and Unity's (paper, section System).
//
//   normal of a vertex = sum over the triangles (vertex, j, k) about it of (p_j - p) x (p_k - p), so weighted by area
//   ring[ring_starts[v] .. ring_starts[v + 1]) = (j, k) in turning order, counter-clockwise seen from outside
//   shadow of p on the ground y = h, light falling along l: p - l (p.y - h) / l.y
//
// Buffers are arguments, so that each includer declares only what it binds. Reference: python/mua/player/surface.py.

#ifndef MUA_SURFACE_DRAW_HLSL
#define MUA_SURFACE_DRAW_HLSL

#include "common.hlsl"

static const float AMBIENT = 0.28; // of the colour, where the light only grazes
static const float INSIDE = 0.45; // of the colour, on the inside of an open surface
static const float TURNED = 0.25; // cosine past the outline from which on a surface is surely seen from inside
static const float BEHIND_SPLATS = 0.01; // metres that a surface yields in depth, so that the splats on it cover it
static const float SMALLEST_LENGTH = 1e-20; // keeps the direction of a vanishing normal finite
static const uint MASK_ROW = 256; // bytes: what graphics interfaces copy from a texture has rows of multiples of it
static const float NEAREST_W = 1e-3; // clip w at which a bone that passes the camera is cut

struct SurfaceVaryings
{
    float4 position : SV_Position;
    float3 normal : TEXCOORD0; // world, outwards
    float3 toCamera : TEXCOORD1; // world, metres
};

// A stroke of even width on the screen: a bone, or a dot where both ends are one joint.
struct StrokeVaryings
{
    float4 position : SV_Position;
    noperspective float2 offset : TEXCOORD0; // pixels along and across, from the stroke's middle
    nointerpolation float2 extent : TEXCOORD1; // half its length between the ends, half its width, pixels
};

float3 surfaceSplat(StructuredBuffer<uint4> splats, uint splat)
{
    return asfloat(splats[2 * splat].xyz);
}

// Sum of the normals of the triangles about a texel, times twice their areas. An avatar's splats begin at firstSplat.
float3 surfaceTexelNormal(uint texel, uint firstSplat, StructuredBuffer<uint4> splats,
                          StructuredBuffer<uint> ringStarts, StructuredBuffer<uint2> ring)
{
    float3 place = surfaceSplat(splats, firstSplat + texel);
    float3 normal = 0;
    uint end = ringStarts[texel + 1];
    [loop]
    for (uint i = ringStarts[texel]; i < end; ++i)
        normal += cross(surfaceSplat(splats, firstSplat + ring[i].x) - place,
                        surfaceSplat(splats, firstSplat + ring[i].y) - place);
    return normal;
}

// A vertex of the coarse mesh in the world.
float3 surfaceVertex(uint vertex, StructuredBuffer<float4> vertexDq, StructuredBuffer<float> mesh)
{
    float3 canonical = float3(mesh[3 * vertex], mesh[3 * vertex + 1], mesh[3 * vertex + 2]);
    return dualTransform(vertexDq[2 * vertex], vertexDq[2 * vertex + 1], canonical);
}

// A vertex of a lit surface; its normal may have any length.
SurfaceVaryings surfaceVaryings(float3 place, float3 normal, float3 camera, float4x4 viewProjection)
{
    float3 toCamera = camera - place;
    float3 yielding = place - toCamera * (BEHIND_SPLATS / max(length(toCamera), SMALLEST_LENGTH));
    float4 clip = mul(viewProjection, float4(place, 1));
    float4 clipYielding = mul(viewProjection, float4(yielding, 1));
    SurfaceVaryings varyings;
    varyings.position = float4(clip.xy, clip.w * clipYielding.z / max(clipYielding.w, SMALLEST_LENGTH), clip.w);
    varyings.normal = normal / max(length(normal), SMALLEST_LENGTH);
    varyings.toCamera = toCamera;
    return varyings;
}

// Head-light and ambient light; the inside of an open surface is darker, so that a flipped normal shows.
float3 surfaceShade(SurfaceVaryings varyings, float3 color)
{
    float facing = dot(normalize(varyings.normal), normalize(varyings.toCamera));
    float inside = saturate(-facing / TURNED); // smooth normals turn away a little before the outline
    return color * (AMBIENT + (1 - AMBIENT) * abs(facing)) * lerp(1, INSIDE, inside);
}

// The same light on a flat facet, whose two sides are alike.
float3 facetShade(float3 toCamera, float3 color)
{
    float3 normal = cross(ddx(toCamera), ddy(toCamera));
    float facing = dot(normal, toCamera) / max(length(normal) * length(toCamera), SMALLEST_LENGTH);
    return color * (AMBIENT + (1 - AMBIENT) * abs(facing));
}

// Where the light carries a point to the ground.
float3 shadowPlace(float3 place, float3 light, float ground)
{
    return place - light * ((place.y - ground) / light.y);
}

// Weights of four neighbouring samples at a place 0..1 between the inner two: a cubic B-spline, soft and without steps.
float4 splineWeights(float t)
{
    float s = 1 - t;
    return float4(s * s * s, 4 - 6 * t * t + 3 * t * t * t, 4 - 6 * s * s + 3 * s * s * s, t * t * t) / 6;
}

// Covered share of the ground at `at`, in samples of a square mask of bytes, four to a word, whose rows are MASK_ROW
// apart; nothing outside it.
float shadowCover(float2 at, uint size, StructuredBuffer<uint> mask)
{
    float2 low = floor(at - 0.5);
    float4 across = splineWeights(at.x - 0.5 - low.x);
    float4 down = splineWeights(at.y - 0.5 - low.y);
    float cover = 0;
    [unroll]
    for (int i = 0; i < 16; ++i)
    {
        int2 place = int2(low) + int2(i % 4, i / 4) - 1;
        bool inside = all(place >= 0) && all(place < int(size));
        uint index = inside ? uint(place.y) * MASK_ROW + uint(place.x) : 0;
        float covered = ((mask[index / 4] >> (8 * (index % 4))) & 0xff) / 255.0;
        cover += inside ? covered * across[i % 4] * down[i / 4] : 0;
    }
    return cover;
}

// An end of a stroke in clip space, moved towards the other end until it lies before the camera.
float4 strokeEnd(float4 end, float4 other)
{
    float share = saturate((NEAREST_W - end.w) / max(other.w - end.w, SMALLEST_LENGTH));
    return end.w < NEAREST_W ? lerp(end, other, share) : end;
}

// One of six vertices of a stroke between two points, `width` pixels wide and round at both ends.
StrokeVaryings strokeVertex(uint corner, float3 start, float3 end, float width, float2 screen, float4x4 viewProjection)
{
    float4 first = mul(viewProjection, float4(start, 1));
    float4 last = mul(viewProjection, float4(end, 1));
    bool hidden = max(first.w, last.w) < NEAREST_W;
    float4 clippedFirst = strokeEnd(first, last);
    float4 clippedLast = strokeEnd(last, first);
    float2 from = clippedFirst.xy / max(clippedFirst.w, NEAREST_W) * screen / 2; // pixels, rows running up
    float2 to = clippedLast.xy / max(clippedLast.w, NEAREST_W) * screen / 2;
    float reach = distance(from, to);
    float2 along = reach > 0 ? (to - from) / reach : float2(1, 0);

    StrokeVaryings varyings;
    varyings.extent = float2(reach / 2, width / 2);
    bool right = corner == 1 || corner == 2 || corner == 4;
    bool below = corner == 2 || corner == 4 || corner == 5;
    varyings.offset = float2(right ? 1 : -1, below ? 1 : -1) * (float2(reach / 2, 0) + width / 2 + 1);
    float2 place = (from + to) / 2 + along * varyings.offset.x + float2(-along.y, along.x) * varyings.offset.y;
    varyings.position = hidden ? float4(2, 2, 0, 1) : float4(2 * place / screen, 0, 1);
    return varyings;
}

// Covered share of a pixel by a stroke, its edge one pixel soft.
float strokeCover(StrokeVaryings varyings)
{
    float2 beyond = float2(max(abs(varyings.offset.x) - varyings.extent.x, 0), varyings.offset.y);
    return saturate(varyings.extent.y + 0.5 - length(beyond));
}

#endif
