using Mua.SelfTest;
using UnityEditor;
using UnityEditor.Build;
using UnityEngine;

namespace Mua.Editor
{
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
                Debug.LogWarning("MUA: the player cannot test its kernels: " + GoldenFolder.Missing);
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
