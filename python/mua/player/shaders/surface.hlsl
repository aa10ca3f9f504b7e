// The desktop player's detailed geometry: the texel grid over the splat centres, lit.

#include "surface_draw.hlsl"

StructuredBuffer<uint4> splats; // [2 M] of all avatars, 32 bytes each; the centre is read
StructuredBuffer<uint> ring_starts; // [N + 1] into ring
StructuredBuffer<uint2> ring; // the other corners of the triangles about each texel

cbuffer Constants
{
    float4x4 view_projection; // of this eye, clip z in 0..w
    float4 camera; // this eye's position, world
    float4 color; // sRGB
    uint first_splat; // of the avatar
};

SurfaceVaryings SurfaceVert(uint texel : SV_VertexID)
{
    float3 normal = surfaceTexelNormal(texel, first_splat, splats, ring_starts, ring);
    return surfaceVaryings(surfaceSplat(splats, first_splat + texel), normal, camera.xyz, view_projection);
}

float4 SurfaceFrag(SurfaceVaryings varyings) : SV_Target
{
    return float4(surfaceShade(varyings, color.rgb), 1);
}
