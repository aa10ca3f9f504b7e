// Letters of a TextMesh that stand in the scene, unlike those of the font's own material, which are drawn over everything.
// They go with the opaque objects and write depth, though their rims are blended: what is drawn later, avatars among it, is
// hidden behind letters that are nearer, and drawn over letters that are further away.
Shader "Hidden/MUA/Text"
{
    Properties
    {
        _MainTex ("Font texture", 2D) = "white" {}
    }

    SubShader
    {
        Tags { "Queue" = "AlphaTest" "RenderType" = "TransparentCutout" "IgnoreProjector" = "True" }
        Blend SrcAlpha OneMinusSrcAlpha
        ZTest LEqual
        ZWrite On
        Cull Off

        Pass
        {
            Name "Text"

            HLSLPROGRAM
            #pragma target 4.5
            #pragma vertex TextVert
            #pragma fragment TextFrag

            #include "UnityCG.cginc"

            static const float LEAST_OPACITY = 0.1; // below, a rim of letters hides nothing

            Texture2D<float4> _MainTex; // of the font; alpha covers
            SamplerState sampler_MainTex;

            struct Attributes
            {
                float3 place : POSITION;
                float4 color : COLOR;
                float2 uv : TEXCOORD0;
                UNITY_VERTEX_INPUT_INSTANCE_ID
            };

            struct Varyings
            {
                float4 position : SV_Position;
                float4 color : COLOR;
                float2 uv : TEXCOORD0;
                UNITY_VERTEX_OUTPUT_STEREO
            };

            Varyings TextVert(Attributes attributes)
            {
                UNITY_SETUP_INSTANCE_ID(attributes);
                Varyings varyings;
                varyings.position = UnityObjectToClipPos(attributes.place);
                varyings.color = attributes.color;
                varyings.uv = attributes.uv;
                UNITY_INITIALIZE_VERTEX_OUTPUT_STEREO(varyings);
                return varyings;
            }

            float4 TextFrag(Varyings varyings) : SV_Target
            {
                UNITY_SETUP_STEREO_EYE_INDEX_POST_VERTEX(varyings);
                float opacity = varyings.color.a * _MainTex.Sample(sampler_MainTex, varyings.uv).a;
                clip(opacity - LEAST_OPACITY);
                return float4(varyings.color.rgb, opacity);
            }
            ENDHLSL
        }
    }
}
