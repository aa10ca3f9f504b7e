using System.Collections.Generic;
using System.IO;
using System.Linq;
using UnityEditor;
using UnityEngine;

namespace Mua.Editor
{
    /// <summary>
    /// Sets a project up for avatars in a headset: on a Quest by itself, and on a PC with a Quest linked. Both may be used
    /// on one project; what is right already is left alone. Not yet verified in the editor.
    /// </summary>
    public static class ProjectSetup
    {
        /// <summary>Sets up for a Quest; in batch mode ends the editor, with 0, 1 or, to be run again, 3.</summary>
        [MenuItem("MUA/Set Up Project for Quest", false, 20)]
        public static void Quest()
        {
            Start(BuildTarget.Android);
        }

        /// <summary>Sets up for Windows with a headset linked; in batch mode ends the editor as Quest does.</summary>
        [MenuItem("MUA/Set Up Project for PC Link", false, 21)]
        public static void PcLink()
        {
            Start(BuildTarget.StandaloneWindows64);
        }

        /// <summary>A sentence for each setting that is wrong for the active platform.</summary>
        public static IReadOnlyList<string> Check()
        {
            return Check(Nearest());
        }

        /// <summary>A sentence for each setting that is wrong for Android (Quest) or StandaloneWindows64 (PC Link); changes nothing.</summary>
        public static IReadOnlyList<string> Check(BuildTarget target)
        {
            string unable = Unable(target);
            if (unable != null)
            {
                return new[] { unable };
            }
            IEnumerable<string> absent = ProjectPackages.Missing().Select(ProjectPackages.HowToAdd);
            return absent.Concat(Settings(target).Select(setting => setting.Fault)).Where(fault => fault != null).ToArray();
        }

        /// <summary>
        /// Makes every setting right, logs what it changed, and returns what is still wrong. Needs its packages.
        /// </summary>
        internal static IReadOnlyList<string> Apply(BuildTarget target)
        {
            if (Unable(target) == null)
            {
                foreach (ProjectSetting setting in Settings(target))
                {
                    Report(setting.Make());
                }
                AssetDatabase.SaveAssets();
            }
            return Check(target);
        }

        /// <summary>Logs what Check says of the platform that is active.</summary>
        [MenuItem("MUA/Check Project", false, 22)]
        internal static void Tell()
        {
            Tell(Check(), Nearest());
        }

        /// <summary>Null, or why this editor cannot build for a platform.</summary>
        internal static string Unable(BuildTarget target)
        {
            bool isAble = BuildPipeline.IsBuildTargetSupported(BuildPipeline.GetBuildTargetGroup(target), target);
            return isAble ? null : $"This editor cannot build for {Name(target)}: add '{Module(target)}' with Unity Hub";
        }

        [InitializeOnLoadMethod]
        private static void Resume()
        {
            BuildTarget target;
            if (ProjectPackages.HasWaited(out target))
            {
                EditorApplication.delayCall += () => Start(target);
            }
        }

        private static void Start(BuildTarget target)
        {
            ProjectOutcome outcome = Run(target);
            if (Application.isBatchMode)
            {
                EditorApplication.Exit((int)outcome);
            }
        }

        private static ProjectOutcome Run(BuildTarget target)
        {
            if (EditorApplication.isPlayingOrWillChangePlaymode)
            {
                Debug.LogError("MUA: leave play mode before setting up the project.");
                return ProjectOutcome.Failed;
            }
            IReadOnlyList<string> missing = ProjectPackages.Missing();
            if (missing.Count > 0 && Unable(target) == null)
            {
                return Application.isBatchMode ? ProjectPackages.Add(missing) : ProjectPackages.Ask(missing, target);
            }
            IReadOnlyList<string> faults = Apply(target);
            Tell(faults, target);
            return faults.Count == 0 ? ProjectOutcome.Done : ProjectOutcome.Failed;
        }

        private static void Tell(IReadOnlyList<string> faults, BuildTarget target)
        {
            string mark = Application.isBatchMode ? "MUA-BUILD FAIL" : "MUA:";
            foreach (string fault in faults)
            {
                Debug.LogError($"{mark} {fault}");
            }
            if (faults.Count == 0)
            {
                Debug.Log($"MUA: the project is set up for {Name(target)}.");
            }
        }

        // Lazily: a setting may need what the one before it made.
        private static IEnumerable<ProjectSetting> Settings(BuildTarget target)
        {
            bool isQuest = target == BuildTarget.Android;
            IEnumerable<ProjectSetting> player = isQuest ? ProjectPlayer.Quest() : ProjectPlayer.PcLink();
            return player
                .Concat(ProjectGraphics.Settings(isQuest))
                .Concat(ProjectXr.Settings(target))
                .Concat(ProjectPlayer.Active(target));
        }

        private static BuildTarget Nearest()
        {
            bool isQuest = EditorUserBuildSettings.activeBuildTarget == BuildTarget.Android;
            return isQuest ? BuildTarget.Android : BuildTarget.StandaloneWindows64;
        }

        private static string Module(BuildTarget target)
        {
            return target == BuildTarget.Android ? "Android Build Support" : "Windows Build Support";
        }

        private static string Name(BuildTarget target)
        {
            return target == BuildTarget.Android ? "Quest" : "PC Link";
        }

        private static void Report(string change)
        {
            if (change != null)
            {
                Debug.Log($"MUA set {change}");
            }
        }
    }

    /// <summary>How a run ended; the number is the editor's exit code in batch mode.</summary>
    internal enum ProjectOutcome
    {
        Done = 0,
        Failed = 1,

        /// <summary>Packages or scripts were added; run the same command once more.</summary>
        Again = 3, // 2 is Unity's own, for tests
    }

    /// <summary>Folders of a project for what set-up and the build make.</summary>
    internal static class ProjectAssets
    {
        public const string Folder = "Assets/MUA";

        /// <summary>Makes a folder, and those above it, where there is none.</summary>
        public static void MakeFolder(string path)
        {
            path = path.Replace('\\', '/');
            if (AssetDatabase.IsValidFolder(path))
            {
                return;
            }
            string parent = Path.GetDirectoryName(path);
            MakeFolder(parent);
            AssetDatabase.CreateFolder(parent.Replace('\\', '/'), Path.GetFileName(path));
        }
    }
}
