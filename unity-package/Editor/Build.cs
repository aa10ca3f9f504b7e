using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.IO;
using System.Linq;
using UnityEditor;
using UnityEditor.Build;
using UnityEditor.Build.Reporting;
using UnityEngine;
using Debug = UnityEngine.Debug;

namespace Mua.Editor
{
    /// <summary>
    /// Builds the player without a window: `-executeMethod Mua.Editor.Build.Quest -muaOutput PATH [-muaDevelopment]`. Ends
    /// the editor with 0 and a file, or with 1 and `MUA-BUILD FAIL` and a sentence in the log, or with 3 and
    /// `MUA-BUILD AGAIN` where packages or scripts were added and the same command has to be run once more. Not yet
    /// verified in the editor.
    /// </summary>
    public static class Build
    {
        private const string OutputWord = "-muaOutput";
        private const string DevelopmentWord = "-muaDevelopment";
        private const double Megabyte = 1e6;

        /// <summary>Writes the APK for a Quest to `-muaOutput`.</summary>
        public static void Quest()
        {
            Start(BuildTarget.Android);
        }

        /// <summary>Writes the player for Windows to the folder `-muaOutput`.</summary>
        public static void PcLink()
        {
            Start(BuildTarget.StandaloneWindows64);
        }

        /// <summary>Whether what is being built is the player, and not a user's own application.</summary>
        internal static bool IsOfPlayer { get; private set; }

        internal static ProjectOutcome Run(BuildTarget target, string[] words)
        {
            try
            {
                return Try(target, words);
            }
            catch (BuildFailedException refusal)
            {
                return Fail(refusal.Message);
            }
            catch (Exception unforeseen)
            {
                Debug.LogException(unforeseen);
                return Fail($"{unforeseen.GetType().Name}: {unforeseen.Message}");
            }
        }

        private static void Start(BuildTarget target)
        {
            ProjectOutcome outcome = Run(target, Environment.GetCommandLineArgs());
            if (Application.isBatchMode)
            {
                EditorApplication.Exit((int)outcome);
            }
        }

        private static ProjectOutcome Try(BuildTarget target, string[] words)
        {
            var output = new BuildOutput(target, Output(words));
            bool isDevelopment = Array.IndexOf(words, DevelopmentWord) >= 0;
            Require(ProjectSetup.Unable(target));
            output.Prepare();
            ProjectOutcome brought = Bring();
            if (brought != ProjectOutcome.Done)
            {
                return brought;
            }
            Require(ProjectSetup.Apply(target).ToArray());
            var watch = Stopwatch.StartNew();
            Write(target, isDevelopment, PlayerSample.CreateScene(), output);
            Debug.Log(FormattableString.Invariant(
                $"MUA-BUILD OK {output.Path}, {output.Size() / Megabyte:0.0} MB, {watch.Elapsed.TotalSeconds:0} s"));
            return ProjectOutcome.Done;
        }

        /// <summary>A full path. Errors: BuildFailedException where no output is named.</summary>
        private static string Output(string[] words)
        {
            int at = Array.IndexOf(words, OutputWord) + 1;
            string output = at > 0 && at < words.Length ? words[at] : "";
            if (output.Length == 0 || output.StartsWith("-"))
            {
                throw new BuildFailedException($"the command line has no {OutputWord} PATH, expected where to write the player");
            }
            return Path.GetFullPath(output).TrimEnd(Path.DirectorySeparatorChar, Path.AltDirectorySeparatorChar);
        }

        // Both at once, so that one more run is enough.
        private static ProjectOutcome Bring()
        {
            bool isImported = !PlayerSample.IsCompiled && PlayerSample.Import();
            IReadOnlyList<string> missing = ProjectPackages.Missing();
            if (missing.Count > 0)
            {
                return ProjectPackages.Add(missing);
            }
            if (isImported)
            {
                Debug.Log($"MUA-BUILD AGAIN imported the sample {PlayerSample.Name}");
            }
            return isImported ? ProjectOutcome.Again : ProjectOutcome.Done;
        }

        private static void Write(BuildTarget target, bool isDevelopment, string scene, BuildOutput output)
        {
            var options = new BuildPlayerOptions
            {
                scenes = new[] { scene },
                locationPathName = output.Unfinished,
                target = target,
                targetGroup = BuildPipeline.GetBuildTargetGroup(target),
                options = isDevelopment ? BuildOptions.Development : BuildOptions.None,
            };
            try
            {
                Directory.CreateDirectory(Path.GetDirectoryName(output.Unfinished));
                Require(BuildAsPlayer(options).summary);
                output.Finish();
            }
            finally
            {
                output.Discard();
            }
        }

        // Under the name that mua-deploy knows, as one APK; the project keeps its own.
        private static BuildReport BuildAsPlayer(BuildPlayerOptions options)
        {
            NamedBuildTarget named = NamedBuildTarget.FromBuildTargetGroup(options.targetGroup);
            string identifier = PlayerSettings.GetApplicationIdentifier(named);
            bool isBundle = EditorUserBuildSettings.buildAppBundle;
            bool isExport = EditorUserBuildSettings.exportAsGoogleAndroidProject;
            IsOfPlayer = true;
            try
            {
                PlayerSettings.SetApplicationIdentifier(named, ProjectPlayer.Identifier);
                EditorUserBuildSettings.buildAppBundle = false;
                EditorUserBuildSettings.exportAsGoogleAndroidProject = false;
                return BuildPipeline.BuildPlayer(options);
            }
            finally
            {
                PlayerSettings.SetApplicationIdentifier(named, identifier);
                EditorUserBuildSettings.buildAppBundle = isBundle;
                EditorUserBuildSettings.exportAsGoogleAndroidProject = isExport;
                IsOfPlayer = false;
            }
        }

        private static void Require(params string[] faults)
        {
            string all = string.Join("; ", faults.Where(fault => fault != null));
            if (all.Length > 0)
            {
                throw new BuildFailedException(all);
            }
        }

        private static void Require(BuildSummary summary)
        {
            if (summary.result != BuildResult.Succeeded)
            {
                throw new BuildFailedException(
                    $"Unity's build ended as {summary.result} with {summary.totalErrors} errors: see the lines above");
            }
        }

        private static ProjectOutcome Fail(string sentence)
        {
            string line = sentence.Split('\n').First().Trim(); // mua-deploy reads one
            Debug.LogError($"MUA-BUILD FAIL {line}");
            return ProjectOutcome.Failed;
        }
    }
}
