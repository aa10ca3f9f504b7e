using System;
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
        private readonly CommandBuffer compute = new CommandBuffer { name = "MUA compute" };
        private readonly CommandBuffer draw = new CommandBuffer { name = "MUA draw" };

        public AvatarBuiltIn(AvatarWorld world)
        {
            this.world = world;
            Camera.onPreRender += BeforeCamera;
            Camera.onPostRender += AfterCamera;
        }

        public void Dispose()
        {
            Camera.onPreRender -= BeforeCamera;
            Camera.onPostRender -= AfterCamera;
            compute.Dispose();
            draw.Dispose();
        }

        private void BeforeCamera(Camera camera)
        {
            if (GraphicsSettings.currentRenderPipeline != null || camera.cameraType == CameraType.Preview)
            {
                return; // a render pipeline calls no Camera events, but a part of it may
            }
            Take(camera);
            compute.Clear();
            draw.Clear();
            bool hasDraws = world.Record(compute, camera, eyes);
            Graphics.ExecuteCommandBuffer(compute);
            if (!hasDraws)
            {
                return;
            }
            for (int i = 0; i < world.Draws.Count; i++)
            {
                world.Draws[i].Append(draw);
            }
            camera.AddCommandBuffer(Moment, draw);
        }

        private void AfterCamera(Camera camera)
        {
            if (GraphicsSettings.currentRenderPipeline == null)
            {
                camera.RemoveCommandBuffer(Moment, draw);
            }
        }

        private void Take(Camera camera)
        {
            if (!camera.stereoEnabled)
            {
                eyes.Begin(camera.pixelWidth, camera.pixelHeight, camera.nearClipPlane);
                eyes.Add(camera.worldToCameraMatrix, camera.projectionMatrix);
                return;
            }
            bool instanced = XRSettings.stereoRenderingMode == XRSettings.StereoRenderingMode.SinglePassInstanced;
            eyes.Begin(
                XRSettings.eyeTextureWidth, XRSettings.eyeTextureHeight, camera.nearClipPlane,
                instanced ? AvatarEyes.Most : 1);
            eyes.Add(
                camera.GetStereoViewMatrix(Camera.StereoscopicEye.Left),
                camera.GetStereoProjectionMatrix(Camera.StereoscopicEye.Left));
            eyes.Add(
                camera.GetStereoViewMatrix(Camera.StereoscopicEye.Right),
                camera.GetStereoProjectionMatrix(Camera.StereoscopicEye.Right));
        }
    }
}
