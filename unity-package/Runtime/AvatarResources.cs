using UnityEngine;

namespace Mua
{
    /// <summary>The package's kernels and shaders; the one asset of this kind lies in Runtime/Resources.</summary>
    public sealed class AvatarResources : ScriptableObject
    {
        private const string Asset = "MuaAvatarResources";

        [SerializeField] private ComputeShader mlpMatmul = null;
        [SerializeField] private ComputeShader blendSubbands = null;
        [SerializeField] private ComputeShader inverseDwt = null;
        [SerializeField] private ComputeShader dqSkinning = null;
        [SerializeField] private ComputeShader splatProject = null;
        [SerializeField] private ComputeShader splatSort = null;
        [SerializeField] private Shader splat = null;
        [SerializeField] private Shader surface = null;

        internal ComputeShader MlpMatmul => mlpMatmul;

        internal ComputeShader BlendSubbands => blendSubbands;

        internal ComputeShader InverseDwt => inverseDwt;

        internal ComputeShader DqSkinning => dqSkinning;

        internal ComputeShader SplatProject => splatProject;

        internal ComputeShader SplatSort => splatSort;

        /// <summary>Draws sorted splats.</summary>
        internal Shader Splat => splat;

        /// <summary>Draws detailed geometry, the template mesh, the skeleton and shadows.</summary>
        internal Shader Surface => surface;

        /// <summary>The package's own; null where its import failed.</summary>
        internal static AvatarResources Load()
        {
            return Resources.Load<AvatarResources>(Asset);
        }
    }
}
