using System.Collections;
using Mua.SelfTest;
using UnityEditor;
using UnityEditor.Build;
using UnityEngine;

namespace Mua.Editor
{
    /// <summary>The self-test on the editor's own device, as the player runs it on a headset.</summary>
    internal static class SelfTestCommand
    {
        private const string Title = "MUA self-test";
        private const string Run = "editor"; // in place of the digits that mua-deploy gives

        /// <summary>Runs all cases and says in a dialog how many passed; the console has each.</summary>
        [MenuItem("MUA/Run Self-Test", false, 40)]
        public static void Execute()
        {
            string folder = GoldenFolder.Find(GoldenFile.Stems[0] + ".json");
            if (folder == null)
            {
                EditorUtility.DisplayDialog(Title, GoldenFolder.Missing, "OK");
                return;
            }
            var test = new SelfTestRun(Run, folder);
            IEnumerator steps = test.Run();
            while (steps.MoveNext())
            {
            }
            string sentence = test.Passed + " of " + test.Total + " cases passed on " + SystemInfo.graphicsDeviceName;
            EditorUtility.DisplayDialog(Title, sentence + (test.HasPassed ? "." : "; the console lists the others."), "OK");
        }
    }

    /// <summary>Puts golden files into builds of the player, which mua-deploy tests; into no other application.</summary>
    internal sealed class SelfTestData : BuildPlayerProcessor
    {
        private static readonly string[] Endings = { ".json", ".bin" };

        public override void PrepareForBuild(BuildPlayerContext buildPlayerContext)
        {
            if (!Build.IsOfPlayer && PlayerSettings.applicationIdentifier != ProjectPlayer.Identifier)
            {
                return;
            }
            string folder = GoldenFolder.Find(GoldenFile.Stems[0] + Endings[0]);
            if (folder == null)
            {
                Debug.LogWarning("MUA: the build cannot run the self-test: " + GoldenFolder.Missing);
                return;
            }
            foreach (string stem in GoldenFile.Stems)
            {
                foreach (string ending in Endings)
                {
                    buildPlayerContext.AddAdditionalPathToStreamingAssets(
                        folder + "/" + stem + ending, GoldenFolder.Name + "/" + stem + ending);
                }
            }
        }
    }
}
