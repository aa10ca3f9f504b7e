using System;
using UnityEngine;
using UnityEngine.Rendering;

namespace Mua
{
    /// <summary>The package's kernels and shaders; the one asset of this kind lies in Runtime/Resources.</summary>
    public sealed class AvatarResources : ScriptableObject
    {
        private const string Asset = "MuaAvatarResources";
        private const int BuffersOfKernel = 8;
        private const int BuffersOfVertex = 3; // of a direct draw of splats, or of the geometry

        [SerializeField] private ComputeShader mlpMatmul = null;
        [SerializeField] private ComputeShader blendSubbands = null;
        [SerializeField] private ComputeShader inverseDwt = null;
        [SerializeField] private ComputeShader dqSkinning = null;
        [SerializeField] private ComputeShader expressions = null;
        [SerializeField] private ComputeShader splatProject = null;
        [SerializeField] private ComputeShader splatSort = null;
        [SerializeField] private Shader splat = null;
        [SerializeField] private Shader surface = null;

        internal ComputeShader MlpMatmul => mlpMatmul;

        internal ComputeShader BlendSubbands => blendSubbands;

        internal ComputeShader InverseDwt => inverseDwt;

        internal ComputeShader DqSkinning => dqSkinning;

        internal ComputeShader Expressions => expressions;

        internal ComputeShader SplatProject => splatProject;

        internal ComputeShader SplatSort => splatSort;

        /// <summary>Draws sorted splats.</summary>
        internal Shader Splat => splat;

        /// <summary>Draws detailed geometry, the template, the skeleton and shadows.</summary>
        internal Shader Surface => surface;

        /// <summary>The package's own; null where its import failed.</summary>
        internal static AvatarResources Load()
        {
            return Resources.Load<AvatarResources>(Asset);
        }

        /// <summary>
        /// The package's own, on a device that can run them. InvalidOperationException says what the device or the package
        /// lacks; an avatar's own kernels are looked for when its AvatarFrame is made.
        /// </summary>
        internal static AvatarResources Require()
        {
            RequireDevice();
            AvatarResources resources = Load();
            if (resources == null)
            {
                throw new InvalidOperationException(
                    "Runtime/Resources/MuaAvatarResources of com.mua.avatar is missing; reimport the package.");
            }
            new SplatProject(resources.splatProject);
            new SplatSort(resources.splatSort);
            return resources;
        }

        private static void RequireDevice()
        {
            string missing = null;
            if (SystemInfo.graphicsDeviceType == GraphicsDeviceType.Null)
            {
                throw new InvalidOperationException("There is no graphics device, so that nothing is drawn (-nographics).");
            }
            if (Application.platform == RuntimePlatform.WebGLPlayer)
            {
                throw new InvalidOperationException(
                    "Unity's players for the web have no threads to read avatars; show them by MUA's player for browsers.");
            }
            if (!SystemInfo.supportsComputeShaders)
            {
                missing = "does not support compute shaders; MUA needs Vulkan, Direct3D 11 or 12, or Metal.";
            }
            else if (SystemInfo.maxComputeBufferInputsCompute < BuffersOfKernel)
            {
                missing = "allows " + SystemInfo.maxComputeBufferInputsCompute + " buffers in a compute kernel; MUA needs "
                    + BuffersOfKernel + ".";
            }
            else if (SystemInfo.maxComputeBufferInputsVertex < BuffersOfVertex)
            {
                missing = "allows " + SystemInfo.maxComputeBufferInputsVertex + " buffers in a vertex shader; MUA needs "
                    + BuffersOfVertex + ".";
            }
            if (missing != null)
            {
                throw new InvalidOperationException(
                    SystemInfo.graphicsDeviceName + " (" + SystemInfo.graphicsDeviceType + ") " + missing);
            }
        }
    }
}
