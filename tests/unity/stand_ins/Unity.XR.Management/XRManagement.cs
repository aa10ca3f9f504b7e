// Stand-in. Source: com.unity.xr.management 4.6, XRGeneralSettings.cs, XRManagerSettings.cs, XRLoader.cs.
using System.Collections.Generic;

namespace UnityEngine.XR.Management
{
    public abstract class XRLoader : ScriptableObject { }

    public class XRGeneralSettings : ScriptableObject
    {
        public static string k_SettingsKey = "com.unity.xr.management.loader_settings";

        public XRManagerSettings Manager { get; set; }
        public bool InitManagerOnStart { get; set; }
    }

    public sealed class XRManagerSettings : ScriptableObject
    {
        private readonly List<XRLoader> loaders = new List<XRLoader>();

        public IReadOnlyList<XRLoader> activeLoaders { get { return loaders; } }
        public bool TryAddLoader(XRLoader loader, int index = -1)
        {
            bool isNew = !loaders.Contains(loader);
            if (isNew)
                loaders.Insert(index < 0 ? loaders.Count : index, loader);
            return isNew;
        }
    }
}
