using System;
using System.Collections.Generic;
using UnityEngine;
using UnityEngine.Rendering;
using UnityEngine.XR;

namespace Mua
{
    /// <summary>Draws the world of avatars in the built-in render pipeline, behind other transparent objects.</summary>
    internal sealed class AvatarBuiltIn : IDisposable
    {
        private const CameraEvent Moment = CameraEvent.BeforeForwardAlpha;

        private readonly AvatarWorld world;
        private readonly AvatarEyes eyes = new AvatarEyes();
        private readonly List<XRDisplaySubsystem> displays = new List<XRDisplaySubsystem>();
        private readonly CommandBuffer compute = new CommandBuffer { name = "MUA compute" };
        private readonly CommandBuffer draw = new CommandBuffer { name = "MUA draw" };

        private Camera camera; // that `draw` is attached to, until another is rendered

        public AvatarBuiltIn(AvatarWorld world)
        {
            this.world = world;
            Camera.onPreRender += BeforeCamera;
        }

        /// <summary>Forgets what the camera that is being rendered was to draw.</summary>
        public void Clear()
        {
            draw.Clear();
        }

        public void Dispose()
        {
            Camera.onPreRender -= BeforeCamera;
            Detach();
            compute.Dispose();
            draw.Dispose();
        }

        private void BeforeCamera(Camera rendered)
        {
            if (GraphicsSettings.currentRenderPipeline != null)
            {
                return; // a render pipeline calls no Camera events, but a part of it may
            }
            Detach();
            compute.Clear();
            draw.Clear();
            Take(rendered);
            bool hasDraws = world.Record(compute, rendered, eyes);
            Graphics.ExecuteCommandBuffer(compute);
            if (!hasDraws)
            {
                return;
            }
            draw.BeginSample(AvatarStages.Draw);
            for (int i = 0; i < world.Draws.Count; i++)
            {
                world.Draws[i].Append(draw);
            }
            draw.EndSample(AvatarStages.Draw);
            rendered.AddCommandBuffer(Moment, draw);
            camera = rendered;
        }

        private void Detach()
        {
            if (camera != null)
            {
                camera.RemoveCommandBuffer(Moment, draw);
            }
            camera = null;
        }

        /// <summary>
        /// Both eyes of a headset, however it draws them: in one pass by two instances or by multiview, or in two passes,
        /// of which each takes its own eye of the two.
        /// </summary>
        private void Take(Camera rendered)
        {
            XRDisplaySubsystem display = rendered.stereoEnabled ? Headset() : null;
            if (display == null)
            {
                eyes.Begin(rendered.scaledPixelWidth, rendered.scaledPixelHeight, rendered.nearClipPlane);
                eyes.Add(rendered.worldToCameraMatrix, rendered.projectionMatrix);
                return;
            }
            display.GetRenderPass(0, out XRDisplaySubsystem.XRRenderPass pass);
            RenderTextureDescriptor target = pass.renderTargetDesc;
            float scale = display.appliedViewportScale;
            bool isSinglePass = target.dimension == TextureDimension.Tex2DArray;
            eyes.Begin(
                Mathf.CeilToInt(scale * target.width), Mathf.CeilToInt(scale * target.height), rendered.nearClipPlane,
                isSinglePass && !SystemInfo.supportsMultiview ? AvatarEyes.Most : 1);
            eyes.Add(
                rendered.GetStereoViewMatrix(Camera.StereoscopicEye.Left),
                rendered.GetStereoProjectionMatrix(Camera.StereoscopicEye.Left));
            eyes.Add(
                rendered.GetStereoViewMatrix(Camera.StereoscopicEye.Right),
                rendered.GetStereoProjectionMatrix(Camera.StereoscopicEye.Right));
        }

        /// <summary>The display that renders; null while there is none.</summary>
        private XRDisplaySubsystem Headset()
        {
            SubsystemManager.GetSubsystems(displays);
            for (int i = 0; i < displays.Count; i++)
            {
                if (displays[i].running && displays[i].GetRenderPassCount() > 0)
                {
                    return displays[i];
                }
            }
            return null;
        }
    }
}
