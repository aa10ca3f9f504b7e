// Splats as quads: what the desktop player's shader and Unity's share, and splat_project.compute with them.
//
//   alpha  = min(peak exp(-(along / wide_major)^2 / 2 - (across / wide_minor)^2 / 2), 0.99)
//   peak   = opacity (major minor) / (wide_major wide_minor),  wide = sqrt(deviation^2 + 1 / 12)
//   color = max(0.5 + C0 c0 + C1 (-y c1 + z c2 - x c3), 0)     (x, y, z) from camera to splat, turned back by its texel
//
// The Gaussian is integrated over the pixel as the Gaussian that has the integral's sum and variance: the unit square has
// 1/12 along any line through its middle. That is off by at most 1/480 / minor^4, and below 0.5 pixels by at most 0.09 of a
// whole opacity; sums over pixels are exact. A fragment computes one exponential.
//
// Six vertices a splat, two triangles, in the order of the sort: back to front. Blend One, OneMinusSrcAlpha.
// Buffers are arguments, so that each includer declares only what it binds. Reference: python/mua/kernels/splat_draw.py.

#ifndef MUA_SPLAT_DRAW_HLSL
#define MUA_SPLAT_DRAW_HLSL

#include "common.hlsl"

#ifndef LEAST_DEPTH
#define LEAST_DEPTH 0.0 // of clip z / w; an includer for OpenGL says -1
#endif

static const float LEAST_OPACITY = 1.0 / 255.0; // below it a splat changes no 8-bit image
static const float MOST_ALPHA = 0.99; // of one splat at one pixel
static const float SH_C0 = 0.28209479177387814;
static const float SH_C1 = 0.4886025119029199;
static const float PIXEL_VARIANCE = 1.0 / 12.0; // px^2, of a unit square
static const float LEAST_SHARE = 1.0 / 16.0; // of its opacity that a smaller splat's quad is made for: many may add up
static const float EXPONENT = 0.8493218002880191; // square root of log2(e) / 2: exp(-x^2 / 2) = 2^-(EXPONENT x)^2
static const float SMALLEST_DISTANCE = 1e-30; // metres; keeps the direction finite where the camera sits on a splat

struct SplatVaryings
{
    float4 position : SV_Position;
    float2 offset : TEXCOORD0; // along and across the ellipse; its square is what halves the peak
    nointerpolation float4 color : TEXCOORD1; // sRGB, not premultiplied; log2 of the peak
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

// Standard deviations of the Gaussian integrated over pixels.
float2 splatWide(float2 deviations)
{
    return sqrt(deviations * deviations + PIXEL_VARIANCE);
}

// Share of its opacity that a splat has in the middle.
float splatShare(float2 deviations, float2 wide)
{
    return deviations.x / wide.x * (deviations.y / wide.y);
}

// How many standard deviations from its middle alpha falls to LEAST_OPACITY.
float splatReach(float opacity, float share)
{
    return sqrt(max(2 * log(opacity * max(share, LEAST_SHARE) / LEAST_OPACITY), 0));
}

// Half lengths of the quad along the ellipse's axes, pixels.
float2 splatHalfLengths(float2 deviations, float opacity)
{
    float2 wide = splatWide(deviations);
    return wide * splatReach(opacity, splatShare(deviations, wide));
}

// Corner of a quad for one of its six vertices, each coordinate -1 or 1.
float2 splatCorner(uint corner)
{
    bool right = corner == 1 || corner == 2 || corner == 4;
    bool below = corner == 2 || corner == 4 || corner == 5;
    return float2(right ? 1 : -1, below ? 1 : -1);
}

// One vertex of a splat's quad for one eye, outside the clip volume where that eye does not see the splat. Rows of
// pixels run down from clip y = 1. The depth is that of the splat's centre, so that what else is drawn can hide it.
// splats = [2 N] as pack_splats of python/mua/kernels/splat_project.py lays them out.
SplatVaryings splatVertex(uint vertex, uint eye, float2 screen, float4x4 viewProjection, StructuredBuffer<uint> order,
                          StructuredBuffer<uint4> splats)
{
    uint splat = 2 * order[vertex / 6];
    uint4 head = splats[splat];
    uint4 tail = splats[splat + 1];
    float4 color = float4(unpackHalves(head.w), unpackHalves(tail.x));
    float2 major = unpackHalves(eye == 0 ? tail.y : tail.z);
    float2 deviations = float2(length(major), halfAt(tail.w, eye));
    float2 axis = major / max(deviations.x, LEAST_NORM);

    float2 wide = splatWide(deviations);
    float share = splatShare(deviations, wide);
    float2 corner = splatCorner(vertex % 6) * splatReach(color.a, share);
    float2 offset = corner * wide;
    float2 pixels = float2(axis.x * offset.x - axis.y * offset.y, axis.y * offset.x + axis.x * offset.y);
    float4 clip = mul(viewProjection, float4(asfloat(head.xyz), 1));
    float2 place = clip.xy / clip.w + pixels * float2(2, -2) / screen;
    float depth = clamp(clip.z / clip.w, LEAST_DEPTH, 1);
    bool seen = deviations.y > 0;

    SplatVaryings varyings;
    varyings.position = float4(2, 2, 0, 1);
    if (seen)
        varyings.position = float4(place, depth, 1);
    varyings.offset = EXPONENT * corner;
    varyings.color = float4(color.rgb, log2(max(color.a * share, LEAST_NORM)));
    return varyings;
}

// Premultiplied sRGB and alpha of a splat at a pixel.
float4 splatFragment(SplatVaryings varyings)
{
    float alpha = min(exp2(varyings.color.a - dot(varyings.offset, varyings.offset)), MOST_ALPHA);
    return float4(varyings.color.rgb * alpha, alpha);
}

#endif
