// Stand-in. Source: Unity 6000.0, BuildPipelineInterfaces.cs, BuildReport.
namespace UnityEditor.Build
{
    public interface IOrderedCallback { int callbackOrder { get; } }
    public interface IPreprocessBuildWithReport : IOrderedCallback { void OnPreprocessBuild(Reporting.BuildReport report); }
}

namespace UnityEditor.Build.Reporting
{
    public sealed class BuildReport : UnityEngine.Object { public BuildSummary summary { get; internal set; } }
    public enum BuildResult { Unknown = 0, Succeeded = 1, Failed = 2, Cancelled = 3 }

    public struct BuildSummary
    {
        public BuildSummary(BuildResult ended, int errors) : this() { result = ended; totalErrors = errors; } // a test's

        public BuildResult result { get; private set; }
        public int totalErrors { get; private set; }
    }
}
