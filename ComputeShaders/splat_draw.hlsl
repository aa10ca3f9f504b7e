// Splats as quads: what the desktop player's shader and Unity's share, and splat_project.compute with them.
//
//   alpha  = peak (1 - u^2) (1 - v^2)                                          inside the quad, 0 at its edges
//   (u, v) = inverse(REACH root) (pixel - middle),  root^2 = covariance + PIXEL_VARIANCE
//   peak   = WEIGHT opacity sqrt(|covariance|) / |root|
//   color = max(0.5 + C0 c0 + C1 (-y c1 + z c2 - x c3), 0)     (x, y, z) from camera to splat, turned back by its texel
//
// In place of the Gaussian a window of the same integral is drawn, whose quad has a third of the area that lies within
// alpha = 1/255, and which costs no exponential; it ends at REACH deviations, where its quad does. What it takes from one splat
// it gives to the next: tens of splats lie over one another. A pixel's own variance, 1/12 along any line, is added in full.
// The root is the symmetric one: it changes little where the covariance does, also of round ellipses, whose axes are any.
//
// A splat is one triangle around its quad, outside which alpha is 0, or the quad's two halves, for the same picture: a small
// one costs less by the triangle than by the pixel. Drawn in the order of the sort, back to front. Blend One, OneMinusSrcAlpha.
// Buffers are arguments, so that each includer declares only what it binds. Reference: python/mua/kernels/splat_draw.py.

#ifndef MUA_SPLAT_DRAW_HLSL
#define MUA_SPLAT_DRAW_HLSL

#include "common.hlsl"

#ifndef LEAST_DEPTH
#define LEAST_DEPTH 0.0 // of clip z / w; an includer for OpenGL defines -1
#endif

#ifndef SHADE
#define SHADE float // type of what a fragment computes; an includer defines half where that is enough, and faster on mobile devices
#define SHADE2 float2
#define SHADE3 float3
#define SHADE4 float4
#endif

static const float LEAST_OPACITY = 1.0 / 255.0; // below it a splat changes no 8-bit image
static const float REACH = 2.015; // deviations from a splat's middle to its quad's edges
static const float WEIGHT = 1.125 * 3.14159265358979 / (REACH * REACH); // the Gaussian's integral, 2 pi, over the window's
static const float PIXEL_VARIANCE = 5.0 / 12.0 / (REACH * REACH); // px^2; the window's is REACH^2 / 5 of its deviation's
static const uint COLOR_STEPS = 1023; // 10 bits
static const uint TINT_STEPS = 63; // either way, 7 bits
static const uint OPACITY_STEPS = 2047; // 11 bits
static const float SH_C0 = 0.28209479177387814;
static const float SH_C1 = 0.4886025119029199;
static const float SMALLEST_DISTANCE = 1e-30; // metres; keeps the direction finite where the camera sits on a splat

struct SplatVaryings
{
    float4 position : SV_Position;
    SHADE2 offset : TEXCOORD0; // (u, v), -1 and 1 at the quad's edges
    nointerpolation SHADE4 color : TEXCOORD1; // sRGB, not premultiplied; the peak
};

// Colour of a splat towards the camera. rotation = R_tex; sh = constant term, then y, z, x.
float3 splatColor(float3 centre, float4 rotation, float3 sh[4], float3 camera)
{
    float3 direction = centre - camera;
    direction /= max(length(direction), SMALLEST_DISTANCE);
    direction = quaternionRotate(quaternionConjugate(rotation), direction);
    float3 color = 0.5 + SH_C0 * sh[0] + SH_C1 * (direction.z * sh[2] - direction.y * sh[1] - direction.x * sh[3]);
    return max(color, 0);
}

// What COLOR_STEPS stand for: 1, 2, 4 or 8.
float colorScale(uint exponent)
{
    return float(1u << exponent);
}

// Colour towards an eye, and opacity: as pack_colors of python/mua/kernels/splat_project.py lays them out.
float4 unpackColor(uint2 words, uint eye)
{
    uint3 steps = uint3(words.x, words.x >> 10, words.x >> 20) & COLOR_STEPS;
    uint3 tints = uint3(words.y >> 11, words.y >> 18, words.y >> 25) & 127;
    float3 tint = float3(tints) - (TINT_STEPS + 1.0);
    float3 color = max(float3(steps) + (eye == 0 ? tint : -tint), 0);
    return float4(color * (colorScale(words.x >> 30) / COLOR_STEPS), float(words.y & OPACITY_STEPS) / OPACITY_STEPS);
}

// Standard deviations of what is drawn of a Gaussian.
float2 splatWide(float2 deviations)
{
    return sqrt(deviations * deviations + PIXEL_VARIANCE);
}

// Share of its opacity that a splat has in the middle.
float splatShare(float2 deviations, float2 wide)
{
    return WEIGHT * (deviations.x / wide.x) * (deviations.y / wide.y);
}

// A corner of the quad from its middle, pixels: REACH root corner.
float2 splatOffset(float2 axis, float2 wide, float2 corner)
{
    return REACH * (wide.y * corner + (wide.x - wide.y) * dot(axis, corner) * axis);
}

// Half width and height of the upright box around the quad, pixels.
float2 splatExtent(float2 axis, float2 wide)
{
    float2 size = abs(axis);
    return REACH * (wide.y + (wide.x - wide.y) * (size.x + size.y) * size);
}

// A splat's corner, its quad having sides at -1 and 1: of the triangle around the quad, or of the quad's two halves.
float2 splatCorner(uint corner, uint corners)
{
    bool right = corner == 1 || corner == 2 || corner == 4;
    bool below = corner == 2 || corner == 4 || corner == 5;
    if (corners == 3)
        return float2(corner == 1 ? 3 : -1, corner == 2 ? 3 : -1);
    return float2(right ? 1 : -1, below ? 1 : -1);
}

// One of a splat's 3 or 6 vertices for one eye, outside the clip volume where that eye does not see the splat. Rows of
// pixels run down from clip y = 1. The depth is that of the splat's centre, so that what else is drawn can hide it.
// splats = [2 N] as pack_splats of python/mua/kernels/splat_project.py lays them out.
SplatVaryings splatVertex(uint vertex, uint corners, uint eye, float2 screen, float4x4 viewProjection,
                          StructuredBuffer<uint> order, StructuredBuffer<uint4> splats)
{
    uint place = corners == 3 ? vertex / 3 : vertex / 6; // by constants, which costs no division
    uint splat = 2 * order[place];
    uint4 head = splats[splat];
    uint4 tail = splats[splat + 1];
    float4 color = unpackColor(uint2(head.w, tail.x), eye);
    float2 major = unpackHalves(eye == 0 ? tail.y : tail.z);
    float2 deviations = float2(length(major), halfAt(tail.w, eye));
    float2 axis = major / max(deviations.x, LEAST_NORM);
    bool seen = deviations.y > 0;
    float3 centre = seen ? asfloat(head.xyz) : 0; // chosen as integers, so that head.w stays one: README.md

    float2 wide = splatWide(deviations);
    float2 corner = splatCorner(vertex - corners * place, corners);
    float2 pixels = splatOffset(axis, wide, corner);
    float4 clip = mul(viewProjection, float4(centre, 1));
    float2 at = clip.xy / clip.w + pixels * float2(2, -2) / screen;
    float depth = clamp(clip.z / clip.w, LEAST_DEPTH, 1);

    SplatVaryings varyings;
    varyings.position = float4(2, 2, 0, 1);
    if (seen)
        varyings.position = float4(at, depth, 1);
    varyings.offset = SHADE2(corner);
    varyings.color = SHADE4(color.rgb, color.a * splatShare(deviations, wide));
    return varyings;
}

// Premultiplied sRGB and alpha of a splat at a pixel.
SHADE4 splatFragment(SplatVaryings varyings)
{
    SHADE2 window = saturate(1 - varyings.offset * varyings.offset); // 0 outside the quad
    SHADE alpha = varyings.color.a * window.x * window.y;
    return SHADE4(varyings.color.rgb * alpha, alpha);
}

#endif
