// The desktop player's draw of sorted splats, one eye at a time: ComputeShaders/splat_draw.hlsl with buffers bound.

#include "splat_draw.hlsl"

StructuredBuffer<uint> order; // [M] splats, back to front
StructuredBuffer<float2> ellipses; // [E, N, 3] (column, row), (cos, sin), (major, minor), pixels
StructuredBuffer<uint2> colors; // [N] half floats: red and green, blue and opacity
StructuredBuffer<uint4> splats; // [N, 4] 64 bytes each; the centre is read

cbuffer Constants
{
    float4x4 view_projection; // of this eye, clip z in 0..w
    float2 screen; // of one eye, pixels
    uint eye;
    uint splat_count;
};

SplatVaryings SplatVert(uint vertex : SV_VertexID)
{
    return splatVertex(vertex, eye, splat_count, screen, view_projection, order, ellipses, colors, splats);
}

float4 SplatFrag(SplatVaryings varyings) : SV_Target
{
    return splatFragment(varyings);
}
