// The desktop player's template: the posed coarse mesh, each triangle lit as the flat facet that it is.

#include "surface_draw.hlsl"

StructuredBuffer<float4> vertex_dq; // [V, 2] real and dual part, bind pose to world
StructuredBuffer<float> mesh; // [V, 3] canonical, metres

cbuffer Constants
{
    float4x4 view_projection; // of this eye, clip z in 0..w
    float4 camera; // this eye's position, world
    float4 color; // sRGB
};

SurfaceVaryings TemplateVert(uint vertex : SV_VertexID)
{
    return surfaceVaryings(surfaceVertex(vertex, vertex_dq, mesh), 0, camera.xyz, view_projection);
}

float4 TemplateFrag(SurfaceVaryings varyings) : SV_Target
{
    return float4(facetShade(varyings.toCamera, color.rgb), 1);
}
