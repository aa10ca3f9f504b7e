using System.Collections.Generic;
using System.IO;
using Mua.SelfTest;
using NUnit.Framework;
using UnityEngine;

namespace Mua.Tests
{
    /// <summary>Every kernel on its golden buffers, on the editor's device; a case is a test.</summary>
    public sealed class GoldenTests
    {
        [TestCaseSource(nameof(Cases))]
        public void KernelMeetsGoldenCase(string stem, int index)
        {
            if (!SystemInfo.supportsComputeShaders)
            {
                Assert.Ignore("needs a device with compute shaders: run the editor without -nographics");
            }
            GoldenFile file = Read(stem);
            AvatarResources resources = AvatarResources.Load();
            Assert.IsTrue(resources != null, "Runtime/Resources/MuaAvatarResources did not load");
            Assert.IsEmpty(CaseRun.Difference(SelfTestRun.ShaderOf(resources, stem), file, file.cases[index]));
        }

        [Test]
        public void GoldenFilesArePresent()
        {
            foreach (string stem in GoldenFile.Stems)
            {
                Assert.IsTrue(GoldenFolder.Find(stem + ".json") != null, GoldenFolder.Missing);
            }
        }

        private static IEnumerable<TestCaseData> Cases()
        {
            foreach (string stem in GoldenFile.Stems)
            {
                GoldenFile file = GoldenFolder.Find(stem + ".json") == null ? null : Read(stem);
                for (int i = 0; file != null && i < file.cases.Length; i++)
                {
                    yield return new TestCaseData(stem, i).SetName(stem + "/" + file.cases[i].Word);
                }
            }
        }

        private static GoldenFile Read(string stem)
        {
            string path = GoldenFolder.Find(stem + ".json") + "/" + stem;
            return GoldenFile.Parse(stem, File.ReadAllBytes(path + ".json"), File.ReadAllBytes(path + ".bin"));
        }
    }
}
