// Stand-in. Source: com.unity.xr.meta-openxr 2.5 API documentation.
namespace UnityEngine.XR.OpenXR.Features.Meta
{
    public static class MetaOpenXRDisplaySubsystemExtensions
    {
        public static bool TryRequestDisplayRefreshRate(this XRDisplaySubsystem subsystem, float refreshRate)
        {
            StandIns.Headset.Rate = refreshRate;
            return true;
        }
    }
}
