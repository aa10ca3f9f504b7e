// Stand-in. Source: Unity 6000.0, SubsystemManager.cs, XRDisplaySubsystem.bindings.cs, XRInputSubsystem.bindings.cs.
using System;
using System.Collections.Generic;

namespace UnityEngine
{
    public interface ISubsystem
    {
        bool running { get; }
        void Start();
        void Stop();
        void Destroy();
    }

    public class IntegratedSubsystem : ISubsystem
    {
        public bool running { get; private set; }
        public void Start() { running = true; }
        public void Stop() { running = false; }
        public void Destroy() { running = false; }
    }

    public static class SubsystemManager
    {
        internal static readonly List<ISubsystem> All = new List<ISubsystem>();

        public static void GetSubsystems<T>(List<T> subsystems) where T : ISubsystem
        {
            subsystems.Clear();
            for (int i = 0; i < All.Count; i++)
                if (All[i] is T)
                    subsystems.Add((T)All[i]);
        }
    }
}

namespace UnityEngine.XR
{
    [Flags]
    public enum TrackingOriginModeFlags { Unknown = 0, Device = 1, Floor = 2, TrackingReference = 4, Unbounded = 8 }

    public class XRDisplaySubsystem : IntegratedSubsystem
    {
        public struct XRRenderPass { public RenderTextureDescriptor renderTargetDesc; }

        public float appliedViewportScale { get { return StandIns.Eyes.Scale; } }
        public int GetRenderPassCount() { return StandIns.Eyes.Passes(this); }
        public void GetRenderPass(int renderPassIndex, out XRRenderPass renderPass)
        {
            if (renderPassIndex < 0 || renderPassIndex >= GetRenderPassCount())
                throw new IndexOutOfRangeException("renderPassIndex");
            renderPass = new XRRenderPass { renderTargetDesc = StandIns.Eyes.Target };
        }
        public float foveatedRenderingLevel { get; set; }
        public bool TryGetDisplayRefreshRate(out float displayRefreshRate)
        {
            displayRefreshRate = StandIns.Headset.Rate;
            return running;
        }
    }

    public class XRInputSubsystem : IntegratedSubsystem
    {
        private TrackingOriginModeFlags origin = TrackingOriginModeFlags.Device;

        public bool TrySetTrackingOriginMode(TrackingOriginModeFlags origin)
        {
            this.origin = origin;
            return true;
        }
        public TrackingOriginModeFlags GetTrackingOriginMode() { return origin; }
    }
}

namespace StandIns
{
    using UnityEngine;
    using UnityEngine.XR;

    /// <summary>A headset that comes and goes. Not part of Unity's API.</summary>
    public static class Headset
    {
        static Headset() { Rate = 72; }

        public static float Rate { get; set; } // Hz
        public static XRDisplaySubsystem Display { get; private set; }
        public static XRInputSubsystem Input { get; private set; }

        public static void Connect()
        {
            SubsystemManager.All.Add(Display = new XRDisplaySubsystem());
            SubsystemManager.All.Add(Input = new XRInputSubsystem());
            Display.Start();
            Input.Start();
        }
    }
}
