// Stand-in. Source: facts 4.4, Unity 6000.0, XRSettings.
namespace UnityEngine.XR
{
    public static class XRSettings
    {
        public enum StereoRenderingMode { MultiPass, SinglePass, SinglePassInstanced, SinglePassMultiview }

        static XRSettings()
        {
            renderViewportScale = eyeTextureResolutionScale = 1;
            eyeTextureWidth = 1680;
            eyeTextureHeight = 1760;
        }

        public static bool enabled { get { return isDeviceActive; } }
        public static bool isDeviceActive { get; internal set; }
        public static int eyeTextureWidth { get; internal set; }
        public static int eyeTextureHeight { get; internal set; }
        public static float eyeTextureResolutionScale { get; set; }
        public static float renderViewportScale { get; set; }
        public static StereoRenderingMode stereoRenderingMode { get; internal set; }
    }
}
