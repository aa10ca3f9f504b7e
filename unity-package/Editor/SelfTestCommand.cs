using System.Collections;
using Mua.SelfTest;
using UnityEditor;
using UnityEngine;

namespace Mua.Editor
{
    /// <summary>The self-test on the editor's own device, as the player runs it on a headset.</summary>
    internal static class SelfTestCommand
    {
        private const string Title = "MUA self-test";
        private const string Run = "editor"; // in place of the digits that mua-deploy gives

        /// <summary>Runs all cases and says in a dialog how many passed; the console has each.</summary>
        public static void Execute()
        {
            string folder = GoldenFolder.Find(GoldenFile.Stems[0] + ".json");
            if (folder == null)
            {
                EditorUtility.DisplayDialog(Title, GoldenFolder.Missing, "OK");
                return;
            }
            var test = new SelfTestRun(Run, folder, true);
            IEnumerator steps = test.Run();
            while (steps.MoveNext())
            {
            }
            string sentence = test.Passed + " of " + test.Total + " cases passed on " + SystemInfo.graphicsDeviceName;
            EditorUtility.DisplayDialog(Title, sentence + (test.HasPassed ? "." : "; the console says what failed."), "OK");
        }
    }
}
