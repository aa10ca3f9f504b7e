// The desktop player's draw of sorted splats, one eye at a time: ComputeShaders/splat_draw.hlsl with buffers bound.

#include "splat_draw.hlsl"

StructuredBuffer<uint> order; // [M] splats, back to front
StructuredBuffer<uint4> splats; // [2 N] 32 bytes each

cbuffer Constants
{
    float4x4 view_projection; // of this eye, clip z in 0..w
    float2 screen; // of one eye, pixels
    uint eye;
    uint corners; // vertices of a splat, 3 or 6
};

SplatVaryings SplatVert(uint vertex : SV_VertexID)
{
    return splatVertex(vertex, corners, eye, screen, view_projection, order, splats);
}

// How many splats are drawn at a pixel.
float4 CountFrag(SplatVaryings varyings) : SV_Target
{
    return float4(1, 0, 0, 0);
}

float4 SplatFrag(SplatVaryings varyings) : SV_Target
{
    return splatFragment(varyings);
}
