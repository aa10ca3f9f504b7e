// Runs the VR player in the stand-ins' player loop. Arguments: the folder of the kernels, the story, a folder for Assets, that of
// persistentDataPath, that of StreamingAssets. It prints what tests/unity/test_vr_player.py asks about.
using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Reflection;
using System.Threading;
using Mua.Samples.VrPlayer.Editor;
using StandIns;
using UnityEditor;
using UnityEngine;
using UnityEngine.XR;

namespace Mua.Samples.VrPlayer
{
    internal static partial class PlayerProgram
    {
        private const int Patience = 4000; // frames, with a millisecond each, until loading must be over
        private const float Step = 1f / 72;
        private const string Place = "Assets/Scenes/Player.unity";

        private static AvatarRenderer shown;
        private static Transform user;
        private static TextMesh panel;
        private static Camera head;

        public static int Main(string[] arguments)
        {
            CultureInfo.CurrentCulture = CultureInfo.InvariantCulture;
            Directory.SetCurrentDirectory(arguments[2]);
            Machine.Paths(arguments[4], arguments[3]);
            PackageResources.Place(arguments[0]);
            Machine.Place("LegacyRuntime.ttf", new Font { material = new Material(Shader.Find("GUI/Text Shader")) });
            typeof(PlayerProgram).GetMethod(arguments[1], BindingFlags.Static | BindingFlags.NonPublic).Invoke(null, null);
            foreach (string name in new[] { "User", "Avatar", "Panel", "Help", "Light", "Ground" })
            {
                UnityEngine.Object.DestroyImmediate(GameObject.Find(name));
            }
            Say("alive", Recorder.AliveCount);
            Say("recorders", Markers.Open);
            foreach (KeyValuePair<LogType, string> line in StandIns.Console.Lines)
            {
                Say("log", line.Key + " " + line.Value);
            }
            return 0;
        }

        private static void Scene()
        {
            AvatarAsset[] assets = { AvatarAsset.Create(new byte[0]), AvatarAsset.Create(new byte[0]) };
            AssetDatabase.CreateAsset(assets[0], "Assets/b.muaavatar");
            AssetDatabase.CreateAsset(assets[1], "Assets/a.muaavatar");
            Make();
            Say("saved", string.Join(" ", Scenes.Saved.ToArray()));
            foreach (Transform at in UnityEngine.Object.FindObjectsByType<Transform>(FindObjectsSortMode.None))
            {
                GameObject thing = at.gameObject;
                string kinds = string.Join(" ", new List<Component>(thing.GetComponentsInChildren<Component>())
                    .FindAll(c => c.gameObject == thing && !(c is Transform)).ConvertAll(c => c.GetType().Name).ToArray());
                Say(thing.name, kinds);
            }
            Light light = UnityEngine.Object.FindAnyObjectByType<Light>();
            Say("light", light.type + " " + light.shadows);
            Say("ground", AssetDatabase.LoadAssetAtPath<Material>("Assets/Scenes/PlayerGround.mat")
                == GameObject.Find("Ground").GetComponent<MeshRenderer>().sharedMaterial);
            Say("camera", head.allowHDR + " " + head.allowMSAA + " " + head.clearFlags + " " + head.gameObject.tag);
            Say("faces", Format(shown.transform.forward) + ", the user at " + Format(user.position));
            var given = (AvatarAsset[])typeof(VrPlayer).GetField("avatars", BindingFlags.Instance | BindingFlags.NonPublic)
                .GetValue(user.GetComponent<VrPlayer>());
            Say("avatars", given[0] == assets[1] && given[1] == assets[0] && given.Length == 2);
            Say("help", GameObject.Find("Help").GetComponent<TextMesh>().text.Replace('\n', '|'));
            Say("eyes", head.transform.localPosition.y.ToString("0.00"));
            Say("sees", head.nearClipPlane.ToString("0.00") + " to " + head.farClipPlane.ToString("0"));
            Say("light falls", Format(light.transform.forward));
            foreach (string name in new[] { "Panel", "Help" })
            {
                Transform at = GameObject.Find(name).transform;
                var text = at.GetComponent<TextMesh>();
                Say(name + " stands", Format(at.position) + " faces " + Format(at.forward));
                Say("letters", (0.1f * text.fontSize * text.characterSize).ToString("0.0000") + " " + text.anchor);
            }
        }

        /// <summary>The shader of the panel's letters, and whether they are those of the font.</summary>
        private static void Letters()
        {
            Begin();
            MeshRenderer drawn = panel.GetComponent<MeshRenderer>();
            var texture = new Texture2D(64, 64);
            Say("shader", drawn.sharedMaterial.shader.name);
            Say("own", drawn.sharedMaterial.mainTexture == panel.font.material.mainTexture);
            panel.font.Rebuild(texture);
            Say("own", drawn.sharedMaterial.mainTexture == texture);
        }

        private static void Keys()
        {
            Begin();
            foreach (string key in new[]
            {
                "Space", "Space", "Period", "Comma", "Comma", "RightBracket", "LeftBracket", "LeftBracket", "Digit1", "Digit2", "Digit3",
                "Digit4", "Digit5", "H", "H", "W", "S", "D", "A", "R", "F", "E", "RightArrow", "LeftArrow", "UpArrow", "Backspace",
                "Q", "DownArrow", "Backspace", "PageDown", "PageUp", "PageUp", "Space", "RightArrow",
            })
            {
                StandIns.Keys.Press(key);
                Tell(key);
                StandIns.Keys.Release(key);
            }
            StandIns.Keys.Drag = new Vector2(40, 20);
            Tell("drag");
            StandIns.Keys.Press("Mouse1");
            Tell("right drag");
            StandIns.Keys.Release("Mouse1");
            StandIns.Keys.Drag = Vector2.zero;
            StandIns.Keys.Scroll = 1;
            Tell("wheel");
        }

        private static void Controllers()
        {
            Begin();
            Button(XRNode.RightHand, CommonUsages.primaryButton, "A");
            Button(XRNode.RightHand, CommonUsages.primaryButton, "A");
            Button(XRNode.RightHand, CommonUsages.triggerButton, "right trigger");
            Button(XRNode.LeftHand, CommonUsages.triggerButton, "left trigger");
            Button(XRNode.RightHand, CommonUsages.secondaryButton, "B");
            Button(XRNode.LeftHand, CommonUsages.menuButton, "menu");
            Button(XRNode.LeftHand, CommonUsages.primary2DAxisClick, "left stick pressed");
            Stick(XRNode.LeftHand, new Vector2(0, 1), "left stick up");
            Stick(XRNode.LeftHand, new Vector2(0.1f, -0.1f), "left stick at rest");
            Stick(XRNode.RightHand, new Vector2(1, 0), "right stick right");
            Stick(XRNode.RightHand, new Vector2(0, 1), "right stick up");
            Devices.Report(XRNode.RightHand, CommonUsages.gripButton, true);
            Stick(XRNode.RightHand, new Vector2(1, 0), "right grip, right stick right");
            Devices.Report(XRNode.RightHand, CommonUsages.gripButton, false);
            Button(XRNode.RightHand, CommonUsages.primary2DAxisClick, "right stick pressed");
            Button(XRNode.LeftHand, CommonUsages.secondaryButton, "Y");
            Button(XRNode.LeftHand, CommonUsages.primaryButton, "X");
            Devices.Report(XRNode.LeftHand, CommonUsages.gripButton, true);
            Button(XRNode.RightHand, CommonUsages.primaryButton, "left grip, A");
            Button(XRNode.RightHand, CommonUsages.secondaryButton, "left grip, B");
            Button(XRNode.LeftHand, CommonUsages.primaryButton, "left grip, X");
            Button(XRNode.LeftHand, CommonUsages.secondaryButton, "left grip, Y");
            Button(XRNode.RightHand, CommonUsages.triggerButton, "left grip, right trigger");
            Button(XRNode.LeftHand, CommonUsages.triggerButton, "left grip, left trigger");
        }

        private static void Headset()
        {
            StandIns.Headset.Connect();
            Devices.Report(XRNode.Head, CommonUsages.centerEyePosition, new Vector3(0.5f, 1.8f, 0.25f));
            Devices.Report(XRNode.Head, CommonUsages.centerEyeRotation, Quaternion.Euler(0, 90, 0));
            Begin();
            Frames(72);
            Say("head", Format(head.transform.position) + " looks " + Format(head.transform.forward));
            Say("foveation", StandIns.Headset.Display.foveatedRenderingLevel);
            Say("origin", StandIns.Headset.Input.GetTrackingOriginMode());
            Say("rate", StandIns.Headset.Rate);
            Say("panel", panel.text.Replace('\n', '|'));
            Remember();
            Stick(XRNode.LeftHand, new Vector2(0, 1), "left stick up");
            StandIns.Keys.Press("Mouse1");
            StandIns.Keys.Drag = new Vector2(40, 20);
            Tell("right drag");
            StandIns.Keys.Drag = Vector2.zero;
            Devices.Report(XRNode.RightHand, CommonUsages.primary2DAxis, new Vector2(0, 1));
            Frames(72);
            Devices.Report(XRNode.RightHand, CommonUsages.primary2DAxis, Vector2.zero);
            Frames(1);
            Say("zoomed", Format(head.transform.position) + " near " + head.nearClipPlane.ToString("0.000"));
            Button(XRNode.RightHand, CommonUsages.primary2DAxisClick, "right stick pressed");
            Say("back", Format(head.transform.position) + " looks " + Format(head.transform.forward));
        }

        private static void Panel()
        {
            foreach (string stage in new[] { "coarse mesh", "texture", "pose", "project", "sort" })
            {
                Markers.Measure("MUA " + stage, 250000, 750000);
            }
            Timings.Gpu = 9.84;
            Machine.GpuRecorder(true);
            Make();
            Frames(1);
            Say("first", panel.text.Replace('\n', '|'));
            Begin();
            shown.IsPlaying = false;
            shown.Frame = 3;
            Frames(72);
            Say("panel", panel.text.Replace('\n', '|'));
        }

        private static void Allocates()
        {
            StandIns.Headset.Connect();
            Devices.Report(XRNode.Head, CommonUsages.centerEyePosition, new Vector3(0, 1.8f, 0));
            Devices.Report(XRNode.Head, CommonUsages.centerEyeRotation, Quaternion.identity);
            Devices.Report(XRNode.LeftHand, CommonUsages.primary2DAxis, new Vector2(0.3f, 0.4f));
            Devices.Report(XRNode.RightHand, CommonUsages.primary2DAxis, new Vector2(0.3f, 0.4f));
            foreach (string stage in new[] { "coarse mesh", "texture", "pose", "project", "sort", "draw" })
            {
                Markers.Measure("MUA " + stage, 250000, 750000);
            }
            Begin();
            shown.IsPlaying = true;
            Frames(200);
            int texts = 0;
            long most = 0;
            for (int i = 0; i < 144; i++)
            {
                string text = panel.text;
                long before = GC.GetAllocatedBytesForCurrentThread();
                PlayerLoop.Frame(Step);
                long spent = GC.GetAllocatedBytesForCurrentThread() - before;
                bool isNew = !ReferenceEquals(text, panel.text);
                texts += isNew ? 1 : 0;
                most = isNew ? most : Math.Max(most, spent);
            }
            Say("texts", texts);
            Say("allocated", most);
        }

        private static void Order()
        {
            var asset = AvatarAsset.Create(File.ReadAllBytes(Directory.GetFiles(Application.persistentDataPath + "/avatars")[0]));
            asset.name = "asset";
            AssetDatabase.CreateAsset(asset, "Assets/asset.muaavatar");
            Walk();
        }

        private static void Streams()
        {
            StreamingIndex.Write(Application.streamingAssetsPath);
            Say("index", File.ReadAllText(Path.Combine(Application.streamingAssetsPath, AvatarShelf.Index)).Replace('\n', '|'));
            Machine.Paths("jar:file://" + Application.streamingAssetsPath, Application.persistentDataPath);
            Walk();
        }

        private static void Goes()
        {
            Make();
            for (int i = 0; i < 100; i++)
            {
                Frames(1);
                Thread.Sleep(5);
            }
            Say("panel", panel.text.Replace('\n', '|'));
            Say("state", shown.State + " " + shown.AvatarName);
            StandIns.Keys.Press("PageUp");
            Frames(1);
            Until(100);
            Frames(72);
            Say("on", panel.text.Replace('\n', '|'));
        }

        private static void Switches()
        {
            Make();
            shown.SpreadDecode = false; // else a second set of channels is made where a clip plays
            Begin();
            Frames(2);
            int alive = Recorder.AliveCount;
            for (int i = 0; i < 4; i++)
            {
                StandIns.Keys.Press("PageDown");
                Frames(1);
                StandIns.Keys.Release("PageDown");
                Say("uploading", Recorder.AliveCount < alive);
                Until();
                Frames(2);
                Say("shown", shown.AvatarName.Length > 0);
            }
            Say("kept", Recorder.AliveCount == alive);
        }

        private static void Walk()
        {
            Begin();
            string first = Entry(), at = first;
            do
            {
                Say("entry", at);
                Say("shown", shown.AvatarName);
                StandIns.Keys.Press("PageDown");
                Frames(1);
                StandIns.Keys.Release("PageDown");
                Until();
                Frames(36);
                at = Entry();
            }
            while (at != first);
        }

        /// <summary>Of the panel: "avatar 1/3   name".</summary>
        private static string Entry()
        {
            foreach (string line in panel.text.Split('\n'))
            {
                if (line.StartsWith("avatar "))
                {
                    return line;
                }
            }
            return "";
        }

        private static void Make()
        {
            PlayerScene.Create(Place);
            shown = UnityEngine.Object.FindAnyObjectByType<AvatarRenderer>();
            user = GameObject.Find("User").transform;
            head = UnityEngine.Object.FindAnyObjectByType<Camera>();
            panel = GameObject.Find("Panel").GetComponent<TextMesh>();
        }

        private static void Begin()
        {
            if (shown == null)
            {
                Make();
            }
            Until();
            Frames(36);
            shown.IsPlaying = false;
            shown.Seconds = 0;
            Frames(1);
            Remember();
        }

        private static void Button(XRNode hand, InputFeatureUsage<bool> usage, string name)
        {
            Devices.Report(hand, usage, true);
            Tell(name);
            Devices.Report(hand, usage, false);
            Frames(1);
            Remember();
        }

        private static void Stick(XRNode hand, Vector2 value, string name)
        {
            Devices.Report(hand, CommonUsages.primary2DAxis, value);
            Tell(name);
            Devices.Report(hand, CommonUsages.primary2DAxis, Vector2.zero);
            Frames(1);
            Remember();
        }

        private static void Until(int patience = Patience)
        {
            for (int i = 0; i < patience && shown.State != AvatarState.Ready; i++)
            {
                Frames(1);
                Thread.Sleep(1);
            }
        }

        private static void Frames(int count)
        {
            for (int i = 0; i < count; i++)
            {
                PlayerLoop.Frame(Step);
            }
        }

        private static void Say(string name, object value)
        {
            System.Console.WriteLine(name + "\t" + value);
        }
    }
}
