using System.Collections.Generic;
using System.Linq;
using UnityEditor;
using UnityEngine;
using UnityEngine.Rendering;
#if MUA_URP
using UnityEngine.Rendering.Universal;
#endif

namespace Mua.Editor
{
    /// <summary>
    /// The render pipeline: the universal one for a project that has no materials of its own yet, else the one that it has.
    /// On a Quest nothing that costs a copy of the picture.
    /// </summary>
    internal static class ProjectGraphics
    {
        private const string PipelineName = "Graphics > Render pipeline";
        private const string BuiltIn = "built-in";
        private const string PostProcessing =
            "Packages/com.unity.render-pipelines.universal/Runtime/Data/PostProcessData.asset";
        private const string Universal = "UniversalRenderPipelineAsset";

        /// <summary>Whether URP should be taken: no pipeline was chosen, and no material would have to change.</summary>
        public static bool TakesUrp()
        {
            return GraphicsSettings.defaultRenderPipeline == null && !HasMaterials();
        }

        public static IEnumerable<ProjectSetting> Settings(bool isQuest)
        {
            yield return new ProjectSetting(PipelineName, Universal, PipelineType, IsPipelineRight, TakePipeline);
            if (isQuest && GraphicsSettings.defaultRenderPipeline == null && !TakesUrp())
            {
                yield return ProjectSetting.Of(
                    "Quality > Anti-aliasing", 0, MostSamples, samples => QualitySettings.ForEach(
                        () => QualitySettings.antiAliasing = samples));
            }
#if MUA_URP
#if !UNITY_6000_3_OR_NEWER || (URP_COMPATIBILITY_MODE && !UNITY_6000_4_OR_NEWER) // elsewhere it is not to be had
            RenderGraphSettings graph;
            if (PipelineType() == Universal && GraphicsSettings.TryGetRenderPipelineSettings(out graph))
            {
                yield return ProjectSetting.Of(
                    "Graphics > Compatibility mode", false, () => graph.enableRenderCompatibilityMode,
                    value => graph.enableRenderCompatibilityMode = value);
            }
#endif
            foreach (ProjectSetting setting in isQuest ? Assets().SelectMany(QuestSettings) : new ProjectSetting[0])
            {
                yield return setting;
            }
#endif
        }

        private static bool HasMaterials()
        {
            return AssetDatabase.FindAssets("t:Material", new[] { "Assets" })
                .Select(guid => AssetDatabase.GUIDToAssetPath(guid))
                .Any(path => !path.StartsWith("Assets/Samples/") && !path.StartsWith(ProjectAssets.Folder + "/"));
        }

        private static string PipelineType()
        {
            RenderPipelineAsset asset = GraphicsSettings.defaultRenderPipeline;
            return asset == null ? BuiltIn : asset.GetType().Name;
        }

        private static bool IsPipelineRight()
        {
            return PipelineType() == Universal || (PipelineType() == BuiltIn && !TakesUrp());
        }

        private static int MostSamples()
        {
            int most = 0;
            QualitySettings.ForEach(() => most = Mathf.Max(most, QualitySettings.antiAliasing));
            return most;
        }

#if MUA_URP
        private static void TakePipeline()
        {
            if (PipelineType() != BuiltIn)
            {
                return; // another pipeline, which is its user's to give up
            }
            ProjectAssets.MakeFolder(ProjectAssets.Folder);
            var renderer = ScriptableObject.CreateInstance<UniversalRendererData>();
            renderer.postProcessData = AssetDatabase.LoadAssetAtPath<PostProcessData>(PostProcessing);
            AssetDatabase.CreateAsset(renderer, ProjectAssets.Folder + "/Renderer.asset");
            UniversalRenderPipelineAsset pipeline = UniversalRenderPipelineAsset.Create(renderer);
            AssetDatabase.CreateAsset(pipeline, ProjectAssets.Folder + "/Pipeline.asset");
            GraphicsSettings.defaultRenderPipeline = pipeline;
        }

        private static IEnumerable<UniversalRenderPipelineAsset> Assets()
        {
            var assets = new List<RenderPipelineAsset> { GraphicsSettings.defaultRenderPipeline };
            for (int level = 0; level < QualitySettings.count; level++)
            {
                assets.Add(QualitySettings.GetRenderPipelineAssetAt(level));
            }
            return assets.OfType<UniversalRenderPipelineAsset>().Where(asset => asset != null).Distinct();
        }

        private static IEnumerable<ProjectSetting> QuestSettings(UniversalRenderPipelineAsset asset)
        {
            yield return Of(asset, "HDR", false, found => found.supportsHDR, (found, value) => found.supportsHDR = value);
            yield return Of(asset, "MSAA", 1, found => found.msaaSampleCount, (found, value) => found.msaaSampleCount = value);
            yield return Of(
                asset, "Opaque texture", false, found => found.supportsCameraOpaqueTexture,
                (found, value) => found.supportsCameraOpaqueTexture = value);
            yield return Of(
                asset, "Depth texture", false, found => found.supportsCameraDepthTexture,
                (found, value) => found.supportsCameraDepthTexture = value);
        }

        private static ProjectSetting Of<T>(
            UniversalRenderPipelineAsset asset, string name, T wanted, System.Func<UniversalRenderPipelineAsset, T> read,
            System.Action<UniversalRenderPipelineAsset, T> write)
        {
            return ProjectSetting.In($"{asset.name} > {name}", wanted, () => asset, read, write);
        }
#else
        private static void TakePipeline()
        {
        }
#endif
    }
}
