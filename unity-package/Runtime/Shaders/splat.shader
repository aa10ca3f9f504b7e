// The draw of sorted splats for one or two eyes: splat_draw.hlsl of com.mua.kernels with the buffers that
// Runtime/Kernels/SplatDraw.cs binds. Both passes draw the same: Direct is for a device that takes no counts from
// a buffer, and so draws all splats, of which the visible ones stand first in order.
Shader "Hidden/MUA/Splat"
{
    SubShader
    {
        Tags { "Queue" = "Transparent" "RenderType" = "Transparent" "IgnoreProjector" = "True" }
        Blend One OneMinusSrcAlpha
        ZTest LEqual
        ZWrite Off
        Cull Off

        HLSLINCLUDE
        #include "target.hlsl"
        #define SHADE half // 32 bits on a desktop, 16 on mobile devices, which are off by less than 1/255 by it
        #define SHADE2 half2
        #define SHADE3 half3
        #define SHADE4 half4
        #include "Packages/com.mua.kernels/splat_draw.hlsl"

        StructuredBuffer<uint> order; // [M] splats, back to front
        StructuredBuffer<uint4> splats; // [2 N] 32 bytes each

        float4x4 view_projection[2]; // of each eye, clip y up
        float4 screen; // width and height of one eye, pixels
        uint eye_count;
        uint corners; // vertices of a splat, 3 or 6

        struct Attributes
        {
            uint vertex : SV_VertexID;
            UNITY_VERTEX_INPUT_INSTANCE_ID
        };

        struct Varyings
        {
            SplatVaryings splat;
            UNITY_VERTEX_OUTPUT_STEREO
        };

        Varyings vertexOf(Attributes attributes, bool isVisible)
        {
            UNITY_SETUP_INSTANCE_ID(attributes);
            Varyings varyings;
            varyings.splat = (SplatVaryings)0;
            varyings.splat.position = float4(2, 2, 0, 1); // outside the clip volume
            if (isVisible)
            {
                uint eye = boundEye(eye_count);
                varyings.splat = splatVertex(
                    attributes.vertex, corners, eye, screen.xy, view_projection[eye], order, splats);
                varyings.splat.position = targetPosition(varyings.splat.position);
                varyings.splat.color.rgb = SHADE3(targetColor(varyings.splat.color.rgb));
            }
            UNITY_INITIALIZE_VERTEX_OUTPUT_STEREO(varyings);
            return varyings;
        }

        Varyings SplatVert(Attributes attributes)
        {
            return vertexOf(attributes, true);
        }

        SHADE4 SplatFrag(Varyings varyings) : SV_Target
        {
            UNITY_SETUP_STEREO_EYE_INDEX_POST_VERTEX(varyings);
            return splatFragment(varyings.splat);
        }
        ENDHLSL

        Pass
        {
            Name "Indirect"

            HLSLPROGRAM
            #pragma target 4.5
            #pragma vertex SplatVert
            #pragma fragment SplatFrag
            ENDHLSL
        }

        Pass
        {
            Name "Direct"

            HLSLPROGRAM
            #pragma target 4.5
            #pragma vertex SplatDirectVert
            #pragma fragment SplatFrag

            StructuredBuffer<uint> visible_arguments; // [5]; the first is the vertices of all visible splats

            Varyings SplatDirectVert(Attributes attributes)
            {
                return vertexOf(attributes, attributes.vertex < visible_arguments[0]);
            }
            ENDHLSL
        }
    }
}
