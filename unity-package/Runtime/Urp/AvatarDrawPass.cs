using System.Collections.Generic;
using UnityEngine;
using UnityEngine.Experimental.Rendering;
using UnityEngine.Rendering;
using UnityEngine.Rendering.RenderGraphModule;
using UnityEngine.Rendering.Universal;

namespace Mua
{
    /// <summary>
    /// Draws what AvatarComputePass found, behind other transparent objects and into the targets that URP draws its own
    /// objects into: bound as they are there, so that the graph can merge this pass with its neighbours and a tiled GPU
    /// neither stores nor loads the picture in between.
    /// </summary>
    internal sealed class AvatarDrawPass : AvatarPass
    {
        private static readonly BaseRenderFunc<Data, RasterGraphContext> Run = Execute;

        public AvatarDrawPass()
            : base("MUA draw", RenderPassEvent.BeforeRenderingTransparents)
        {
        }

        protected override void Record(
            RenderGraph graph, ContextContainer frame, UniversalCameraData camera, AvatarWorld world)
        {
            UniversalResourceData targets = frame.Get<UniversalResourceData>();
            TextureHandle color = targets.activeColorTexture, depth = targets.activeDepthTexture;
            if (!color.IsValid())
            {
                return; // the camera renders depth only
            }
            using (IRasterRenderGraphBuilder builder = graph.AddRasterRenderPass(Name, out Data data, profilingSampler))
            {
                data.World = world;
                builder.SetRenderAttachment(color, 0, AccessFlags.ReadWrite);
                if (depth.IsValid())
                {
                    builder.SetRenderAttachmentDepth(depth, AccessFlags.ReadWrite);
                }
                if (camera.xr.enabled)
                {
                    builder.EnableFoveatedRasterization(IsFoveated(camera, targets));
#if UNITY_6000_2_OR_NEWER
                    if (camera.xr.multipassId == 0) // not in the inner views of quad views, as URP's objects
                    {
                        builder.SetExtendedFeatureFlags(ExtendedFeatureFlags.MultiviewRenderRegionsCompatible);
                    }
#endif
                }
                builder.AllowPassCulling(false);
                builder.SetRenderFunc(Run);
            }
        }

        /// <summary>As URP decides for its own objects; passes that differ are not merged.</summary>
        private static bool IsFoveated(UniversalCameraData camera, UniversalResourceData targets)
        {
            bool isWhole = !Application.isMobilePlatform || XRSystem.GetRenderViewportScale().Equals(1);
            return camera.xr.supportsFoveatedRendering && (isWhole || targets.isActiveTargetBackBuffer);
        }

        private static void Execute(Data data, RasterGraphContext context)
        {
            IReadOnlyList<AvatarDraw> draws = data.World.Draws;
            context.cmd.BeginSample(AvatarStages.Draw);
            for (int i = 0; i < draws.Count; i++)
            {
                Append(draws[i], context.cmd);
            }
            context.cmd.EndSample(AvatarStages.Draw);
        }

        /// <summary>AvatarDraw.Append, which has no command buffer in common with this one.</summary>
        private static void Append(in AvatarDraw draw, RasterCommandBuffer commands)
        {
            Matrix4x4 place = Matrix4x4.identity;
            if (draw.Arguments != null)
            {
                commands.DrawProceduralIndirect(
                    place, draw.Material, draw.Pass, MeshTopology.Triangles, draw.Arguments, 0, draw.Properties);
            }
            else if (draw.Indices != null)
            {
                commands.DrawProcedural(
                    draw.Indices, place, draw.Material, draw.Pass, MeshTopology.Triangles, draw.Count, draw.Instances,
                    draw.Properties);
            }
            else
            {
                commands.DrawProcedural(
                    place, draw.Material, draw.Pass, MeshTopology.Triangles, draw.Count, draw.Instances,
                    draw.Properties);
            }
        }

        private sealed class Data
        {
            public AvatarWorld World;
        }
    }
}
