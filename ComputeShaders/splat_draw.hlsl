// Splats as quads: what the desktop player's shader and Unity's share, and splat_project.compute with them.
//
//   S(x)  = 1 / (1 + exp(-1.6 x - 0.07 x^3))                               in place of the normal distribution function
//   alpha = min(opacity 2 pi major minor mass(along, major) mass(across, minor), 0.99)
//   mass(offset, deviation) = S((offset + 0.5) / deviation) - S((offset - 0.5) / deviation)
//   color = max(0.5 + C0 c0 + C1 (-y c1 + z c2 - x c3), 0)     (x, y, z) from camera to splat, turned back by its texel
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
static const float TWO_PI = 6.283185307179586;
static const float SMALLEST_DISTANCE = 1e-30; // metres; keeps the direction finite where the camera sits on a splat
static const float LARGEST_EXPONENT = 80.0; // exp stays finite in float32

struct SplatVaryings
{
    float4 position : SV_Position;
    float2 offset : TEXCOORD0; // along and across the ellipse, pixels from its centre
    nointerpolation float2 deviations : TEXCOORD1; // standard deviations along and across, pixels
    nointerpolation float4 color : TEXCOORD2; // sRGB, not premultiplied; opacity
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

// Half lengths of the quad along the ellipse's axes, pixels: to where opacity x Gaussian falls to LEAST_OPACITY, and
// half a pixel on, for the integral over the pixel.
float2 splatHalfLengths(float2 deviations, float opacity)
{
    float reach = sqrt(max(2 * log(opacity / LEAST_OPACITY), 0));
    return deviations * reach + 0.5;
}

// Mass of the normal distribution within half a unit of the offset, along two axes.
float2 splatMass(float2 offset, float2 deviations)
{
    float2 right = (offset + 0.5) / deviations;
    float2 left = (offset - 0.5) / deviations;
    float2 rightExponent = clamp(-right * (1.6 + 0.07 * right * right), -LARGEST_EXPONENT, LARGEST_EXPONENT);
    float2 leftExponent = clamp(-left * (1.6 + 0.07 * left * left), -LARGEST_EXPONENT, LARGEST_EXPONENT);
    return 1 / (1 + exp(rightExponent)) - 1 / (1 + exp(leftExponent));
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

    float2 offset = splatCorner(vertex % 6) * splatHalfLengths(deviations, color.a);
    float2 pixels = float2(axis.x * offset.x - axis.y * offset.y, axis.y * offset.x + axis.x * offset.y);
    float4 clip = mul(viewProjection, float4(asfloat(head.xyz), 1));
    float2 place = clip.xy / clip.w + pixels * float2(2, -2) / screen;
    float depth = clamp(clip.z / clip.w, LEAST_DEPTH, 1);
    bool seen = deviations.y > 0;

    SplatVaryings varyings;
    varyings.position = float4(2, 2, 0, 1);
    if (seen)
        varyings.position = float4(place, depth, 1);
    varyings.offset = offset;
    varyings.deviations = deviations;
    varyings.color = color;
    return varyings;
}

// Premultiplied sRGB and alpha of a splat at a pixel.
float4 splatFragment(SplatVaryings varyings)
{
    float2 mass = splatMass(varyings.offset, varyings.deviations);
    float integral = TWO_PI * varyings.deviations.x * varyings.deviations.y * mass.x * mass.y;
    float alpha = min(varyings.color.a * integral, MOST_ALPHA);
    return float4(varyings.color.rgb * alpha, alpha);
}

#endif
