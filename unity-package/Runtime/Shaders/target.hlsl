// What the shaders of this package take from Unity of the target that they draw into: eye, direction of rows, colours.
//
// Rows. AvatarEyes hands matrices whose clip y points up on the picture, on every device, and splat_draw.hlsl puts the
// first row of pixels at clip y = 1. Where the first row of a texture is its upper one (Direct3D, Metal, and Vulkan,
// which Unity drives like them) Unity draws render textures upside down, so that their rows agree with OpenGL's, and
// negates the second row of its projections for that. The back buffer is not turned, nor are a headset's textures where
// the pipeline draws straight into them. Only the engine knows which of these is bound, and the projection by which it
// draws everything else shows it: nothing else in the package decides it. (_ProjectionParams.x should agree, but URP
// 17.0 sets it apart from the matrix, as of the back buffer also where a camera draws straight into a texture.)
//
// Depth comes by the matrices as GL.GetGPUProjectionMatrix leaves it: 0..w, reversed or not, and -w..w on OpenGL.

#ifndef MUA_TARGET_HLSL
#define MUA_TARGET_HLSL

#include "UnityCG.cginc"

#if defined(SHADER_API_GLCORE) || defined(SHADER_API_GLES3)
#define LEAST_DEPTH -1.0 // of clip z / w
#endif

static const float SRGB_LINEAR = 0.04045; // IEC 61966-2-1: up to here sRGB is proportional to light
static const float SRGB_SLOPE = 12.92;
static const float SRGB_OFFSET = 0.055;
static const float SRGB_GAMMA = 2.4;

// The eye that is drawn, of those that are bound: both in one pass by multiview or by instances, one after the other in
// two passes, or a single one.
uint boundEye(uint eyeCount)
{
    return min((uint)unity_StereoEyeIndex, eyeCount - 1);
}

// A clip position whose y points up, as this target takes it.
float4 targetPosition(float4 clip)
{
    return float4(clip.x, UNITY_MATRIX_P[1][1] < 0 ? -clip.y : clip.y, clip.zw);
}

// A point of the package's right-handed world in the map of the light whose shadows are drawn: Unity's world mirrors x,
// and both pipelines put the light's matrix, turned as its target needs, where a camera's stands. What lies nearer to
// the light than its volume still casts a shadow: it is drawn on the near side. No bias: only other objects receive.
float4 shadowPosition(float3 place)
{
    float4 clip = mul(UNITY_MATRIX_VP, float4(-place.x, place.yz, 1));
#ifdef UNITY_REVERSED_Z
    clip.z = min(clip.z, clip.w * UNITY_NEAR_CLIP_VALUE);
#else
    clip.z = max(clip.z, clip.w * UNITY_NEAR_CLIP_VALUE);
#endif
    return clip;
}

// Colours of splats are sRGB; a project in linear colour space blends light.
float3 targetColor(float3 srgb)
{
#ifdef UNITY_COLORSPACE_GAMMA
    return srgb;
#else
    float3 light = pow((max(srgb, 0) + SRGB_OFFSET) / (1 + SRGB_OFFSET), SRGB_GAMMA);
    return lerp(light, srgb / SRGB_SLOPE, step(srgb, SRGB_LINEAR));
#endif
}

#endif
