// Stand-in. Source: Unity's manual, "Single-pass instanced rendering and custom shaders" and "Built-in shader
// variables": the names that the package's shaders use, each with what it stands for in a variant.
//
// REPLAYED: for wgpu, whose vertex stage cannot choose a layer of the target and whose passes have one view. Instances of
// the other eye than `replayed_layer` are dropped instead, and the view of a multiview pass is a number.
// VIEW: the semantic of the view's index, where the compiler has one; Unity's finds it by the name of a constant buffer.

#ifndef STAND_IN_UNITY_CG
#define STAND_IN_UNITY_CG

float4x4 unity_MatrixVP; // world to clip of what is drawn: of a light, where its shadows are
#define UNITY_MATRIX_VP unity_MatrixVP
#define UNITY_REVERSED_Z 1 // as on Vulkan, Direct3D and Metal
#define UNITY_NEAR_CLIP_VALUE (1.0)

// Eye to clip of what is drawn, its second row negated where the engine turns the target upside down.
#if defined(STEREO_INSTANCING_ON) || defined(STEREO_MULTIVIEW_ON)
float4x4 unity_StereoMatrixP[2];
#define UNITY_MATRIX_P unity_StereoMatrixP[unity_StereoEyeIndex]
#else
float4x4 glstate_matrix_projection;
#define UNITY_MATRIX_P glstate_matrix_projection
#endif

#if defined(STEREO_INSTANCING_ON)

static uint unity_StereoEyeIndex;
#define UNITY_VERTEX_INPUT_INSTANCE_ID uint instanceID : SV_InstanceID;
#define UNITY_SETUP_INSTANCE_ID(input) unity_StereoEyeIndex = input.instanceID & 1
#define UNITY_INITIALIZE_VERTEX_OUTPUT_STEREO(output) output.layer = unity_StereoEyeIndex
#if defined(REPLAYED)
uint replayed_layer;
#define UNITY_VERTEX_OUTPUT_STEREO nointerpolation uint layer : BLENDINDICES0;
#define UNITY_SETUP_STEREO_EYE_INDEX_POST_VERTEX(input) if (input.layer != replayed_layer) discard
#else
#define UNITY_VERTEX_OUTPUT_STEREO nointerpolation uint layer : SV_RenderTargetArrayIndex;
#define UNITY_SETUP_STEREO_EYE_INDEX_POST_VERTEX(input) unity_StereoEyeIndex = input.layer
#endif

#elif defined(STEREO_MULTIVIEW_ON)

#if defined(REPLAYED)
uint replayed_view;
#define unity_StereoEyeIndex replayed_view
#define UNITY_VERTEX_INPUT_INSTANCE_ID
#define UNITY_SETUP_INSTANCE_ID(input)
#else
#ifndef VIEW
#define VIEW BLENDINDICES1
#endif
static uint unity_StereoEyeIndex;
#define UNITY_VERTEX_INPUT_INSTANCE_ID uint view : VIEW;
#define UNITY_SETUP_INSTANCE_ID(input) unity_StereoEyeIndex = input.view
#endif
#define UNITY_VERTEX_OUTPUT_STEREO nointerpolation uint eye : BLENDINDICES0;
#define UNITY_INITIALIZE_VERTEX_OUTPUT_STEREO(output) output.eye = unity_StereoEyeIndex
#define UNITY_SETUP_STEREO_EYE_INDEX_POST_VERTEX(input)

#else

int unity_StereoEyeIndex; // of the pass where each eye has its own, else 0
#define UNITY_VERTEX_INPUT_INSTANCE_ID
#define UNITY_SETUP_INSTANCE_ID(input)
#define UNITY_VERTEX_OUTPUT_STEREO
#define UNITY_INITIALIZE_VERTEX_OUTPUT_STEREO(output)
#define UNITY_SETUP_STEREO_EYE_INDEX_POST_VERTEX(input)

#endif

// A point of the object that is drawn; here it stands in the middle of the world.
#define UnityObjectToClipPos(place) mul(UNITY_MATRIX_VP, float4(place, 1))

#endif
