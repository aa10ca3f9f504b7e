// Stand-in. Source: Unity 6000.0, BuildTarget, BuildTargetGroup, NamedBuildTarget.cs; the platforms of this package only.
namespace UnityEditor
{
    public enum BuildTarget { StandaloneWindows64 = 19, Android = 13, StandaloneLinux64 = 24 }
    public enum BuildTargetGroup { Unknown = 0, Standalone = 1, Android = 7 }
}

namespace UnityEditor.Build
{
    public struct NamedBuildTarget
    {
        public static readonly NamedBuildTarget Standalone = new NamedBuildTarget("Standalone");
        public static readonly NamedBuildTarget Android = new NamedBuildTarget("Android");

        private NamedBuildTarget(string name) : this() { TargetName = name; }

        public string TargetName { get; private set; }
        public static NamedBuildTarget FromBuildTargetGroup(BuildTargetGroup buildTargetGroup)
        {
            return buildTargetGroup == BuildTargetGroup.Android ? Android : Standalone;
        }
    }
}
