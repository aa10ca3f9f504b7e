// Stand-in. Source: Unity 6000.0, BuildPipeline.bindings.cs, BuildFailedException.cs, BuildPlayerContext.cs; a test says what a build does.
using System;
using System.Collections.Generic;
using UnityEditor.Build.Reporting;

namespace UnityEditor
{
    [Flags]
    public enum BuildOptions { None = 0, Development = 1 }

    public struct BuildPlayerOptions
    {
        public string[] scenes { get; set; }
        public string locationPathName { get; set; }
        public BuildTargetGroup targetGroup { get; set; }
        public BuildTarget target { get; set; }
        public BuildOptions options { get; set; }
    }

    public static class BuildPipeline
    {
        public static BuildTargetGroup GetBuildTargetGroup(BuildTarget platform)
        {
            return platform == BuildTarget.Android ? BuildTargetGroup.Android : BuildTargetGroup.Standalone;
        }
        public static bool IsBuildTargetSupported(BuildTargetGroup buildTargetGroup, BuildTarget target)
        {
            return StandIns.Builds.Modules.Contains(target);
        }
        public static BuildReport BuildPlayer(BuildPlayerOptions buildPlayerOptions)
        {
            return new BuildReport { summary = StandIns.Builds.Answer(buildPlayerOptions) };
        }
    }
}

namespace UnityEditor.Build
{
    public class BuildFailedException : Exception { public BuildFailedException(string message) : base(message) { } }

    public abstract class BuildPlayerProcessor : IOrderedCallback
    {
        public virtual int callbackOrder { get { return 0; } }
        public abstract void PrepareForBuild(BuildPlayerContext buildPlayerContext);
    }

    public sealed class BuildPlayerContext
    {
        internal readonly Dictionary<string, string> Added = new Dictionary<string, string>();

        public void AddAdditionalPathToStreamingAssets(string directoryOrFile, string pathInStreamingAssets = null)
        {
            if (!System.IO.Directory.Exists(directoryOrFile) && !System.IO.File.Exists(directoryOrFile))
                throw new System.IO.FileNotFoundException("No such file or directory.", directoryOrFile);
            Added.Add(pathInStreamingAssets ?? "", directoryOrFile);
        }
    }
}

namespace StandIns
{
    /// <summary>What a build does, and for which platforms. Not part of Unity's API.</summary>
    public static class Builds
    {
        public static readonly HashSet<UnityEditor.BuildTarget> Modules = new HashSet<UnityEditor.BuildTarget>
        {
            UnityEditor.BuildTarget.Android, UnityEditor.BuildTarget.StandaloneWindows64
        };
        public static Func<UnityEditor.BuildPlayerOptions, BuildSummary> Answer;

        /// <summary>By path in StreamingAssets, what a processor adds to a build.</summary>
        public static IReadOnlyDictionary<string, string> Prepare(UnityEditor.Build.BuildPlayerProcessor processor)
        {
            var context = new UnityEditor.Build.BuildPlayerContext();
            processor.PrepareForBuild(context);
            return context.Added;
        }
    }
}
