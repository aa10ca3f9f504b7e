// What is drawn of an avatar beside its splats: the surface through the splats' centres, the template, the bones, and
// the template in the maps of lights. surface_draw.hlsl of com.mua.kernels with the buffers that
// Runtime/Kernels/SurfaceDraw.cs binds; the desktop player's surface.hlsl, template.hlsl and skeleton.hlsl draw the same.
Shader "Hidden/MUA/Surface"
{
    SubShader
    {
        Tags { "Queue" = "Transparent" "RenderType" = "Opaque" "IgnoreProjector" = "True" }
        Blend Off
        Cull Off

        HLSLINCLUDE
        #include "target.hlsl"
        #include "Packages/com.mua.kernels/surface_draw.hlsl"

        StructuredBuffer<uint4> splats; // [2 M] of all avatars, 32 bytes each; the centre is read
        StructuredBuffer<uint> ring_starts; // [N + 1] into ring
        StructuredBuffer<uint2> ring; // the other corners of the triangles about each texel
        StructuredBuffer<float4> vertex_dq; // [V, 2] real and dual part, bind pose to the world divided by size
        StructuredBuffer<float> mesh; // [V, 3] canonical, metres
        StructuredBuffer<float4> joints; // [J, 2] likewise
        StructuredBuffer<float4> rest; // [J] positions in the bind pose, metres
        StructuredBuffer<uint4> strokes; // [S] two joints and a style; a dot names one joint twice

        float4x4 view_projection[2]; // of each eye, clip y up
        float4 cameras[2]; // each eye's position, world
        float4 color; // sRGB
        float4 styles[4]; // of strokes: sRGB, and width in pixels
        float4 screen; // width and height of one eye, pixels
        float size; // how many times as large as baked the avatar is
        uint first_splat; // of the avatar
        uint eye_count;

        struct Attributes
        {
            uint vertex : SV_VertexID;
            UNITY_VERTEX_INPUT_INSTANCE_ID
        };

        struct Varyings
        {
            SurfaceVaryings surface;
            UNITY_VERTEX_OUTPUT_STEREO
        };

        // A vertex of a lit surface, seen by the eye that is drawn.
        Varyings litVertex(float3 place, float3 normal)
        {
            uint eye = boundEye(eye_count);
            Varyings varyings;
            varyings.surface = surfaceVaryings(place, normal, cameras[eye].xyz, view_projection[eye]);
            varyings.surface.position = targetPosition(varyings.surface.position);
            UNITY_INITIALIZE_VERTEX_OUTPUT_STEREO(varyings);
            return varyings;
        }
        ENDHLSL

        Pass
        {
            Name "Geometry"
            ZTest LEqual
            ZWrite On

            HLSLPROGRAM
            #pragma target 4.5
            #pragma vertex GeometryVert
            #pragma fragment GeometryFrag

            Varyings GeometryVert(Attributes attributes)
            {
                UNITY_SETUP_INSTANCE_ID(attributes);
                float3 normal = surfaceTexelNormal(attributes.vertex, first_splat, splats, ring_starts, ring);
                return litVertex(surfaceSplat(splats, first_splat + attributes.vertex), normal);
            }

            float4 GeometryFrag(Varyings varyings) : SV_Target
            {
                UNITY_SETUP_STEREO_EYE_INDEX_POST_VERTEX(varyings);
                return float4(targetColor(surfaceShade(varyings.surface, color.rgb)), 1);
            }
            ENDHLSL
        }

        Pass
        {
            Name "Template"
            ZTest LEqual
            ZWrite On

            HLSLPROGRAM
            #pragma target 4.5
            #pragma vertex MeshVert
            #pragma fragment MeshFrag

            Varyings MeshVert(Attributes attributes)
            {
                UNITY_SETUP_INSTANCE_ID(attributes);
                return litVertex(size * surfaceVertex(attributes.vertex, vertex_dq, mesh), 0);
            }

            float4 MeshFrag(Varyings varyings) : SV_Target
            {
                UNITY_SETUP_STEREO_EYE_INDEX_POST_VERTEX(varyings);
                return float4(targetColor(facetShade(varyings.surface.toCamera, color.rgb)), 1);
            }
            ENDHLSL
        }

        Pass
        {
            Name "Skeleton"
            Blend One OneMinusSrcAlpha
            ZTest Always
            ZWrite Off

            HLSLPROGRAM
            #pragma target 4.5
            #pragma vertex SkeletonVert
            #pragma fragment SkeletonFrag

            struct SkeletonVaryings
            {
                StrokeVaryings stroke;
                nointerpolation float3 color : TEXCOORD2; // of the target's colour space
                UNITY_VERTEX_OUTPUT_STEREO
            };

            float3 joint(uint index)
            {
                return size * dualTransform(joints[2 * index], joints[2 * index + 1], rest[index].xyz);
            }

            SkeletonVaryings SkeletonVert(Attributes attributes)
            {
                UNITY_SETUP_INSTANCE_ID(attributes);
                uint4 ends = strokes[attributes.vertex / 6];
                float4 style = styles[ends.z];
                float4x4 view = view_projection[boundEye(eye_count)];
                SkeletonVaryings varyings;
                varyings.stroke = strokeVertex(attributes.vertex % 6, joint(ends.x), joint(ends.y), style.w, screen.xy,
                                               view);
                varyings.stroke.position = targetPosition(varyings.stroke.position);
                varyings.color = targetColor(style.rgb);
                UNITY_INITIALIZE_VERTEX_OUTPUT_STEREO(varyings);
                return varyings;
            }

            float4 SkeletonFrag(SkeletonVaryings varyings) : SV_Target
            {
                UNITY_SETUP_STEREO_EYE_INDEX_POST_VERTEX(varyings);
                return float4(varyings.color, 1) * strokeCover(varyings.stroke);
            }
            ENDHLSL
        }

        Pass
        {
            Name "ShadowCaster"
            Tags { "LightMode" = "ShadowCaster" }
            ZTest LEqual
            ZWrite On

            HLSLPROGRAM
            #pragma target 4.5
            #pragma vertex ShadowVert
            #pragma fragment ShadowFrag

            float4 ShadowVert(uint vertex : SV_VertexID) : SV_Position
            {
                return shadowPosition(size * surfaceVertex(vertex, vertex_dq, mesh));
            }

            float4 ShadowFrag() : SV_Target
            {
                return 0;
            }
            ENDHLSL
        }
    }
}
