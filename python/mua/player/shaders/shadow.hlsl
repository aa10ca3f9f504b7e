// The desktop player's cast shadow: the posed template is drawn once into a mask of the ground, so that overlaps darken
// once; the ground then reads the mask softly.

#include "surface_draw.hlsl"

StructuredBuffer<float4> vertex_dq; // [V, 2] real and dual part, bind pose to world
StructuredBuffer<float> mesh; // [V, 3] canonical, metres
StructuredBuffer<uint> mask; // [size, MASK_ROW] bytes, of which the first `size` of a row count, four to a word

cbuffer Constants
{
    float4x4 view_projection; // of this eye, clip z in 0..w
    float4 light; // the direction along which it falls, world, and how much it is missed in the shadow
    float4 area; // lowest x and z of the mask's square on the ground, its side, the ground's y, metres
    uint size;
};

struct GroundVaryings
{
    float4 position : SV_Position;
    float2 at : TEXCOORD0; // samples of the mask
};

float4 ShadowVert(uint vertex : SV_VertexID) : SV_Position
{
    float3 place = shadowPlace(surfaceVertex(vertex, vertex_dq, mesh), light.xyz, area.w);
    float2 share = (place.xz - area.xy) / area.z;
    return float4(2 * share.x - 1, 1 - 2 * share.y, 0.5, 1);
}

float4 ShadowFrag() : SV_Target
{
    return 1;
}

GroundVaryings GroundVert(uint vertex : SV_VertexID)
{
    float2 share = float2(vertex & 1, vertex >> 1);
    GroundVaryings varyings;
    varyings.position = mul(view_projection, float4(area.x + share.x * area.z, area.w, area.y + share.y * area.z, 1));
    varyings.at = share * size;
    return varyings;
}

float4 GroundFrag(GroundVaryings varyings) : SV_Target
{
    return float4(0, 0, 0, light.w * shadowCover(varyings.at, size, mask));
}
