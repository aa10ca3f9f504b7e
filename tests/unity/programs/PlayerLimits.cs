// How far the user of the VR player can go: another part of PlayerProgram.cs.
using System.IO;
using StandIns;
using UnityEngine;
using UnityEngine.XR;

namespace Mua.Samples.VrPlayer
{
    internal static partial class PlayerProgram
    {
        private static void Limits()
        {
            Begin();
            foreach (string key in new[] { "UpArrow", "DownArrow" })
            {
                StandIns.Keys.Press(key);
                Frames(72 * 6);
                Say("size after " + key, user.localScale.x.ToString("0.000"));
                StandIns.Keys.Release(key);
                Frames(1);
            }
            StandIns.Keys.Press("Mouse1");
            foreach (float up in new[] { 4000, -8000 })
            {
                StandIns.Keys.Drag = new Vector2(0, up);
                Frames(1);
                StandIns.Keys.Drag = Vector2.zero;
                Frames(1);
                Say("looks after " + up, Format(head.transform.forward));
            }
        }

        /// <summary>A stick pushed further and further, and how far the user walks in ten frames.</summary>
        private static void Sticks()
        {
            Begin();
            foreach (float push in new[] { 0.14f, 0.16f, 0.575f, -0.575f, 1 })
            {
                Vector3 before = user.position;
                Devices.Report(XRNode.LeftHand, CommonUsages.primary2DAxis, new Vector2(0, push));
                Frames(10);
                Say(push.ToString("0.000"), (user.position.z - before.z).ToString("0.0000"));
                Devices.Report(XRNode.LeftHand, CommonUsages.primary2DAxis, Vector2.zero);
                Frames(2);
            }
        }

        /// <summary>A second of turning, of scrubbing and of rising.</summary>
        private static void Speeds()
        {
            Begin();
            foreach (string key in new[] { "E", "R", "RightArrow" })
            {
                StandIns.Keys.Press(key);
                Frames(key == "RightArrow" ? 9 : 72);
                StandIns.Keys.Release(key);
                Frames(1);
            }
            Say("turned", Format(shown.transform.forward));
            Say("risen", user.position.y.ToString("0.00"));
            Say("scrubbed", shown.Seconds.ToString("0.000"));
        }

        /// <summary>The index of an empty StreamingAssets, of none, and of one that lost its avatars.</summary>
        private static void Index()
        {
            string folder = Application.streamingAssetsPath, index = Path.Combine(folder, AvatarShelf.Index);
            Editor.StreamingIndex.Write(folder);
            Say("of nothing", File.Exists(index));
            File.WriteAllText(index, "gone.muaavatar\n");
            Editor.StreamingIndex.Write(folder);
            Say("of what is gone", File.Exists(index));
            Editor.StreamingIndex.Write(Path.Combine(folder, "nowhere"));
            Say("nowhere", Directory.Exists(Path.Combine(folder, "nowhere")));
        }

        private static void HeadsetGoes()
        {
            StandIns.Headset.Connect();
            Begin();
            Frames(72);
            Say("worn", panel.text.Contains("display 72 Hz"));
            StandIns.Headset.Display.Stop();
            Frames(72);
            Say("taken off", panel.text.Contains("display"));
            StandIns.Headset.Display.foveatedRenderingLevel = 0;
            StandIns.Headset.Display.Start();
            Frames(72);
            Say("worn again", panel.text.Contains("display 72 Hz") + " " + StandIns.Headset.Display.foveatedRenderingLevel);
        }
    }
}
