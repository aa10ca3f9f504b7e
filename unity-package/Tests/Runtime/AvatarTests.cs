using System.Collections;
using System.IO;
using Mua.SelfTest;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.TestTools;

namespace Mua.Tests
{
    /// <summary>An avatar in a scene that plays: the small random one that the file format's tests use.</summary>
    public sealed class AvatarTests
    {
        private const string AvatarFile = "synthetic.muaavatar";
        private const float Patience = 20; // seconds
        private const int Frames = 10;

        private GameObject place, eye;

        [SetUp]
        public void MakeScene()
        {
            if (!SystemInfo.supportsComputeShaders)
            {
                Assert.Ignore("needs a device with compute shaders: run the editor without -nographics");
            }
            eye = new GameObject("MUA test camera", typeof(Camera));
            eye.transform.position = new Vector3(0, 1, -3);
            place = new GameObject("MUA test avatar");
        }

        [TearDown]
        public void ClearScene()
        {
            if (eye != null) // a test that is skipped has made none
            {
                Object.DestroyImmediate(place);
                Object.DestroyImmediate(eye);
            }
            Assert.AreEqual(null, AvatarWorld.Current);
        }

        [UnityTest]
        public IEnumerator LoadsAndDrawsAnAsset()
        {
            var shown = place.AddComponent<AvatarRenderer>();
            shown.Load(AvatarAsset.Create(Content()));
            yield return UntilLoaded(shown);
            Assert.AreEqual(AvatarState.Ready, shown.State, shown.Message);
            Assert.AreNotEqual(0, shown.Clips.Count);
            for (int i = 0; i < Frames; i++)
            {
                yield return null;
            }
            Assert.AreEqual(AvatarState.Ready, shown.State, shown.Message);
            Assert.AreNotEqual(0, AvatarWorld.Current.SplatCount);
            LogAssert.NoUnexpectedReceived();
        }

        [UnityTest]
        public IEnumerator LeavesNothingWhenDestroyedWhileItLoads()
        {
            var shown = place.AddComponent<AvatarRenderer>();
            shown.Load(AvatarAsset.Create(Content()));
            Assert.AreEqual(AvatarState.Loading, shown.State);
            yield return null;
            Object.DestroyImmediate(place); // undisposed buffers are reported as errors by Unity's leak detection
            for (int i = 0; i < Frames; i++)
            {
                yield return null;
            }
            Assert.AreEqual(null, AvatarWorld.Current);
            LogAssert.NoUnexpectedReceived();
        }

        [UnityTest]
        public IEnumerator RefusesADamagedAvatar()
        {
            byte[] content = Content();
            content[content.Length / 2] ^= 0xFF;
            var shown = place.AddComponent<AvatarRenderer>();
            LogAssert.Expect(LogType.Error, new System.Text.RegularExpressions.Regex("^MUA: "));
            shown.Load(AvatarAsset.Create(content));
            yield return UntilLoaded(shown);
            Assert.AreEqual(AvatarState.Failed, shown.State);
            Assert.AreNotEqual("", shown.Message);
        }

        private static IEnumerator UntilLoaded(AvatarRenderer shown)
        {
            float begun = Time.realtimeSinceStartup;
            while (shown.State == AvatarState.Loading && Time.realtimeSinceStartup - begun < Patience)
            {
                yield return null;
            }
        }

        private static byte[] Content()
        {
#if UNITY_EDITOR
            string folder = GoldenFolder.Find(AvatarFile);
            Assert.IsTrue(folder != null, GoldenFolder.Missing);
            return File.ReadAllBytes(folder + "/" + AvatarFile);
#else
            Assert.Ignore("runs in the editor, whose package folder has " + AvatarFile);
            return null;
#endif
        }
    }
}
