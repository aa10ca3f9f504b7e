// The desktop player's template: the posed coarse mesh, lit.

#include "surface_draw.hlsl"

StructuredBuffer<float4> vertex_dq; // [V, 2] real and dual part, bind pose to world
StructuredBuffer<float> mesh; // [V, 3] canonical, metres
StructuredBuffer<uint> ring_starts; // [V + 1] into ring
StructuredBuffer<uint2> ring; // the other corners of the triangles about each vertex

cbuffer Constants
{
    float4x4 view_projection; // of this eye, clip z in 0..w
    float4 camera; // this eye's position, world
    float4 color; // sRGB
};

SurfaceVaryings TemplateVert(uint vertex : SV_VertexID)
{
    float3 normal = surfaceVertexNormal(vertex, vertex_dq, mesh, ring_starts, ring);
    return surfaceVaryings(surfaceVertex(vertex, vertex_dq, mesh), normal, camera.xyz, view_projection);
}

float4 TemplateFrag(SurfaceVaryings varyings) : SV_Target
{
    return float4(surfaceShade(varyings, color.rgb), 1);
}
