using System.Collections.Generic;
using UnityEngine;
using UnityEngine.XR;
#if MUA_META_OPENXR && (UNITY_ANDROID || UNITY_EDITOR_WIN)
using UnityEngine.XR.OpenXR.Features.Meta;
#endif

namespace Mua.Samples.VrPlayer
{
    /// <summary>
    /// Sets up the headset once it is there: foveation, the floor as origin, and the display's rate where a package that can
    /// ask for it, com.unity.xr.meta-openxr, is installed; elsewhere the rate stays as the headset or Quest Link has it.
    /// </summary>
    internal sealed class HeadsetDisplay
    {
        private const int FramesOfStart = 3; // until Unity lets a display be asked

        private readonly List<XRDisplaySubsystem> displays = new List<XRDisplaySubsystem>();
        private readonly List<XRInputSubsystem> inputs = new List<XRInputSubsystem>();
        private readonly float foveation;
        private XRDisplaySubsystem display;

        public HeadsetDisplay(float rate, float foveation)
        {
            WantedRate = rate;
            this.foveation = foveation;
        }

        /// <summary>Refresh rate that was asked for, Hz.</summary>
        public float WantedRate { get; }

        /// <summary>Refresh rate of the display, Hz; NaN without a headset.</summary>
        public double Rate
        {
            get
            {
                float rate = 0;
                return display != null && display.TryGetDisplayRefreshRate(out rate) ? rate : double.NaN;
            }
        }

        /// <summary>Level of foveation, from 0 to 1; NaN without a headset.</summary>
        public double Foveation => display == null ? double.NaN : display.foveatedRenderingLevel;

        /// <summary>Notices a headset that was connected or disconnected since the last call.</summary>
        public void Refresh()
        {
            if (display != null && display.running)
            {
                return;
            }
            display = null;
            SubsystemManager.GetSubsystems(displays);
            if (Time.frameCount < FramesOfStart || displays.Count == 0 || !displays[0].running)
            {
                return;
            }
            display = displays[0];
            display.foveatedRenderingLevel = foveation;
            RequestRate();
            SubsystemManager.GetSubsystems(inputs);
            foreach (XRInputSubsystem input in inputs)
            {
                input.TrySetTrackingOriginMode(TrackingOriginModeFlags.Floor);
            }
        }

        private void RequestRate()
        {
#if MUA_META_OPENXR && (UNITY_ANDROID || UNITY_EDITOR_WIN)
            if (!display.TryRequestDisplayRefreshRate(WantedRate))
            {
                Debug.LogWarning("MUA: the headset refused a display rate of " + WantedRate + " Hz and keeps its own.");
            }
#endif
        }
    }
}
