// The desktop player's skeleton: a stroke for each bone and a dot for each joint, over all else.

#include "surface_draw.hlsl"

StructuredBuffer<float4> joints; // [J] world, metres
StructuredBuffer<uint2> strokes; // [S] its two joints; a dot names one joint twice

cbuffer Constants
{
    float4x4 view_projection; // of this eye, clip z in 0..w
    float4 color; // sRGB
    float2 screen; // of one eye, pixels
    float width; // pixels
};

StrokeVaryings StrokeVert(uint vertex : SV_VertexID)
{
    uint2 ends = strokes[vertex / 6];
    return strokeVertex(vertex % 6, joints[ends.x].xyz, joints[ends.y].xyz, width, screen, view_projection);
}

float4 StrokeFrag(StrokeVaryings varyings) : SV_Target
{
    return float4(color.rgb, 1) * strokeCover(varyings);
}
