// Inspectors of assets and of avatars: another part of ImporterProgram.cs.
using System;
using System.Linq;
using System.Reflection;
using StandIns;
using UnityEditor;
using UnityEngine;

namespace Mua.Editor
{
    internal static partial class ImporterProgram
    {
        private static void Inspects()
        {
            var inspector = Inspectors.Open<AvatarAssetEditor>(new Import(new AvatarImporter(), files[0]).Main);
            inspector.OnInspectorGUI();
            Gui.Lines.ForEach(line => Say("gui", line));
        }

        /// <summary>The inspector of a component: another clip, then a frame of it.</summary>
        private static void Scrubs()
        {
            Place(files);
            AvatarRenderer shown = AvatarObject.Create(AvatarObject.Find(), null, Vector3.zero).GetComponent<AvatarRenderer>();
            new GameObject("camera").AddComponent<Camera>();
            var inspector = Inspectors.Open<AvatarRendererEditor>(shown);
            AvatarFrame decoded = shown.Decoded;
            Show(inspector);
            Gui.Answers["Clip"] = 1;
            Show(inspector);
            Messages.Send(shown, "OnValidate");
            PlayerLoop.Frame(1);
            Say("clip", shown.ClipIndex, decoded == shown.Decoded);
            Gui.Answers["Frame"] = 3;
            int updates = Asked.Updates, repaints = Asked.Repaints;
            Show(inspector);
            Say("asked", Asked.Updates - updates, Asked.Repaints - repaints);
            Show(inspector);
            Say("asked", Asked.Updates - updates, Asked.Repaints - repaints);
            PlayerLoop.Frame(1);
            Say("frame", shown.Frame);
            Machine.Playing(true);
            Show(inspector);
            Gui.Answers["Pause"] = true;
            Show(inspector);
            Say("playing", shown.IsPlaying);
            Machine.Playing(false);
            shown.Load("nowhere.muaavatar");
            Show(inspector);
            UnityEngine.Object.DestroyImmediate(shown.gameObject);
            Say("alive", Recorder.AliveCount);
        }

        /// <summary>The inspector of a component with a face: each slider is moved, with one displayed frame after it.</summary>
        private static void MovesFace()
        {
            Place(files);
            AvatarRenderer shown = AvatarObject.Create(AvatarObject.Find(), null, Vector3.zero).GetComponent<AvatarRenderer>();
            new GameObject("camera").AddComponent<Camera>();
            var inspector = Inspectors.Open<AvatarRendererEditor>(shown);
            Show(inspector);
            PlayerLoop.Frame(1);
            Gui.Answers["Expressions"] = true;
            Show(inspector);
            foreach (float weight in new[] { 0.25f, 0.5f })
            {
                Gui.Answers["jawOpen"] = weight;
                int updates = Asked.Updates, dispatches = Recorder.Dispatches;
                Show(inspector);
                PlayerLoop.Frame(0.001f);
                Say("moved", shown.GetExpression("jawOpen"), Asked.Updates - updates, Recorder.Dispatches - dispatches);
            }
            Gui.Answers["Reset Expressions"] = true;
            Show(inspector);
            Say("reset", shown.GetExpression("jawOpen"));
        }

        /// <summary>Plays the clip in the scene view, at twice its speed, until each of what ends that.</summary>
        private static void Previews()
        {
            Place(files);
            AvatarRenderer shown = AvatarObject.Create(AvatarObject.Find(), null, Vector3.zero).GetComponent<AvatarRenderer>();
            shown.Speed = 2;
            string saved = Saved(shown);
            var inspector = Inspectors.Open<AvatarRendererEditor>(shown);
            foreach (string end in new[] { "pause", "deselected", "play mode", "no avatar", "destroyed" })
            {
                Gui.Answers["Play"] = true;
                Show(inspector);
                Tick(0.0625f);
                Show(inspector);
                Say("plays", shown.Seconds, inspector.RequiresConstantRepaint());
                switch (end)
                {
                    case "pause":
                        Gui.Answers["Pause"] = true;
                        Show(inspector);
                        break;
                    case "deselected":
                        Messages.Send(inspector, "OnDisable");
                        break;
                    case "play mode":
                        Machine.Playing(true);
                        break;
                    case "no avatar":
                        Say("saved", Saved(shown) == saved, Dialogs.Dirtied.Count);
                        shown.Load((AvatarAsset)null);
                        break;
                    default:
                        UnityEngine.Object.DestroyImmediate(shown.gameObject);
                        break;
                }
                Tick(0.0625f);
                Machine.Playing(false);
                Say("ended", end, EditorApplication.update == null, shown == null ? 0 : shown.Seconds);
                if (end == "no avatar")
                {
                    shown.Load(AvatarObject.Find());
                }
            }
            Say("alive", Recorder.AliveCount);
        }

        /// <summary>What the scene keeps of a component.</summary>
        private static string Saved(AvatarRenderer shown)
        {
            return string.Join(" ", typeof(AvatarRenderer).GetFields(BindingFlags.Instance | BindingFlags.NonPublic)
                .Where(field => Attribute.IsDefined(field, typeof(SerializeField))).Select(field => field.GetValue(shown)));
        }

        private static void Tick(float seconds)
        {
            EditorApplication.update?.Invoke();
            PlayerLoop.Frame(seconds);
            EditorApplication.update?.Invoke();
        }

        /// <summary>The inspector of two components at once.</summary>
        private static void EditsSeveral()
        {
            Place(files);
            AvatarAsset asset = AvatarObject.Find();
            AvatarRenderer first = AvatarObject.Create(asset, null, Vector3.zero).GetComponent<AvatarRenderer>();
            AvatarRenderer second = AvatarObject.Create(asset, null, Vector3.zero).GetComponent<AvatarRenderer>();
            Show(Inspectors.Open<AvatarRendererEditor>(first, second));
            Show(Inspectors.Open<AvatarRendererEditor>(first));
        }

        private static void Show(UnityEditor.Editor inspector)
        {
            Gui.Lines.Clear();
            inspector.OnInspectorGUI();
            Say("gui", string.Join("; ", Gui.Lines));
        }
    }
}
