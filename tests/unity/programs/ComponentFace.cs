// Stories of ComponentProgram.cs: expressions of an AvatarRenderer, set by an application, by a clip, or by blend shapes of a
// mesh. Meshes of the avatar are kept in a recording beside its file.
using System;
using System.Collections.Generic;
using System.IO;
using StandIns;
using UnityEngine;

namespace Mua
{
    internal static partial class ComponentProgram
    {
        private const int Settled = 8; // frames after which what was set is shown

        private static void SetsExpressions()
        {
            Recorder.Start(Path.ChangeExtension(files[0], null) + " set");
            AvatarRenderer shown = Begin(files[0]);
            Say("early", shown.SetExpression("jawOpen", 1) + " " + shown.ExpressionNames.Count + " " + shown.GetExpression("jawOpen"));
            Until(shown);
            shown.IsPlaying = false;
            Say("names", string.Join(",", new List<string>(shown.ExpressionNames).ToArray()));
            foreach (int frame in new[] { 0, shown.FrameCount - 1 })
            {
                shown.Frame = frame;
                Frames(Settled);
                SayWeights("clip", shown);
                Recorder.Keep(shown.Decoded.Mesh, "clip " + frame);
                foreach (string name in shown.ExpressionNames)
                {
                    shown.SetExpression(name, 0);
                }
                Say("to plain", Dispatches(Settled));
                Recorder.Keep(shown.Decoded.Mesh, "plain " + frame);
                shown.SetExpression("eyeBlinkLeft", 2);
                Say("set", shown.SetExpression("jawOpen", 0.5f));
                Say("to set", Dispatches(Settled));
                Recorder.Keep(shown.Decoded.Mesh, "set " + frame);
                SayWeights("held", shown);
                Say("idle", Dispatches(Settled));
                shown.ResetExpressions();
                Frames(Settled);
                Recorder.Keep(shown.Decoded.Mesh, "again " + frame);
            }
            Say("unknown", shown.SetExpression("nobody's", 1) + " " + shown.GetExpression("nobody's"));
            Say("unknown", shown.SetExpression(null, 1) + " " + shown.GetExpression(null));
            foreach (float weight in new[] { float.NaN, float.NegativeInfinity })
            {
                try
                {
                    shown.SetExpression("jawOpen", weight);
                }
                catch (ArgumentException error)
                {
                    Say("refused", error.Message.Split('\n')[0]);
                }
            }
            Recorder.Stop();
        }

        private static void FollowsFace()
        {
            SkinnedMeshRenderer face = MakeFace("head", "other", "blendShape1.Jaw_Open", "mundAuf", "Mund auf", "EYEBLINKLEFT");
            face.SetBlendShapeWeight(1, 50);
            face.SetBlendShapeWeight(3, 150);
            face.SetBlendShapeWeight(4, float.NaN);
            AvatarRenderer shown = Begin(files[0]);
            shown.Face = face;
            Until(shown);
            shown.IsPlaying = false;
            Frames(2);
            SayWeights("followed", shown);
            shown.SetExpression("jawOpen", 1);
            shown.SetExpression("nothing", 0.25f);
            Frames(2);
            SayWeights("beside", shown);
            shown.SpreadDecode = false;
            Frames(4);
            int before = Recorder.Dispatches;
            for (int i = 0; i < 72; i++)
            {
                face.SetBlendShapeWeight(1, i);
                Frames(1);
            }
            Say("moving", Recorder.Dispatches - before);
            Time.timeScale = 0; // the game is paused
            before = Recorder.Dispatches;
            for (int i = 0; i < 72; i++)
            {
                face.SetBlendShapeWeight(1, i);
                Frames(1);
            }
            Say("moving", Recorder.Dispatches - before);
            Time.timeScale = 1;
            UnityEngine.Object.DestroyImmediate(face.gameObject);
            Frames(2);
            SayWeights("after", shown);
            shown.Face = MakeFace("box", "bulge");
            Say("said", shown.Message);
            shown.Load(files[1]);
            Until(shown);
            Say("said", shown.Message);
        }

        /// <summary>Shape keys of SMPL-X, whose coefficients have either sign, on an avatar that has a pair for each.</summary>
        private static void FollowsCoefficients()
        {
            AvatarRenderer shown = Begin(files[0]);
            Until(shown);
            shown.IsPlaying = false;
            SkinnedMeshRenderer face = MakeFace("head", "Exp001", "SMPLX-mesh.Exp000");
            shown.Face = face;
            foreach (float coefficient in new[] { 2f, -4f, 6f, 0f })
            {
                face.SetBlendShapeWeight(0, -100 * coefficient / 2);
                face.SetBlendShapeWeight(1, 100 * coefficient);
                Frames(2);
                SayWeights("followed", shown);
            }
        }

        /// <summary>A tracker's names on an avatar that has VRM's: set by the application, then by a mesh.</summary>
        private static void TakesTrackersNames()
        {
            AvatarRenderer shown = Begin(files[0]);
            Until(shown);
            shown.IsPlaying = false;
            var followed = new List<string>();
            foreach (string word in "jawOpen=0.6 cheekPuff=1 eyeBlinkLeft=1 eyeBlink_R=0.5 mouthClose=0.2 wink=1".Split(' '))
            {
                string[] pair = word.Split('=');
                followed.Add(shown.SetExpression(pair[0], float.Parse(pair[1])).ToString());
            }
            Say("followed", string.Join(" ", followed.ToArray()));
            Frames(2);
            SayWeights("set", shown);
            long before = GC.GetAllocatedBytesForCurrentThread();
            for (int i = 0; i < 100; i++)
            {
                shown.SetExpression("jawOpen", i / 100f);
            }
            Say("allocated", GC.GetAllocatedBytesForCurrentThread() - before);
            shown.ResetExpressions();
            SayWeights("reset", shown);
            shown.SetExpression("jawOpen", 0.3f);
            SayWeights("anew", shown);
            shown.ResetExpressions();
            SkinnedMeshRenderer face = MakeFace("head", "jawOpen", "mouthClose", "cheekPuff", "eyeBlinkLeft", "blend.smo_king", "SMOKING");
            shown.Face = face;
            for (int shape = 0; shape < 6; shape++)
            {
                face.SetBlendShapeWeight(shape, 90 - 20 * shape);
            }
            Frames(2);
            SayWeights("tracked", shown);
            shown.Face = null;
            SayWeights("reset", shown);
            Say("said", shown.Message);
        }

        /// <summary>An avatar that goes before it is ready, and one whose face goes before.</summary>
        private static void FaceGoesEarly()
        {
            AvatarRenderer gone = Begin(files[0]), shown = Begin(files[0]);
            SkinnedMeshRenderer face = MakeFace("head", "jawOpen");
            gone.Face = shown.Face = face;
            Frames(1);
            UnityEngine.Object.DestroyImmediate(gone.gameObject);
            UnityEngine.Object.DestroyImmediate(face.gameObject);
            Until(shown);
            Frames(2);
            Say("state", shown.State + " " + shown.Message);
        }

        private static SkinnedMeshRenderer MakeFace(string name, params string[] shapes)
        {
            SkinnedMeshRenderer face = Make(name).AddComponent<SkinnedMeshRenderer>();
            face.sharedMesh = new Mesh();
            foreach (string shape in shapes)
            {
                face.sharedMesh.AddBlendShapeFrame(shape, 100, new Vector3[0], null, null);
            }
            return face;
        }

        private static void SayWeights(string key, AvatarRenderer shown)
        {
            var weights = new List<string>();
            foreach (string name in shown.ExpressionNames)
            {
                weights.Add(shown.GetExpression(name).ToString("R"));
            }
            Say(key, string.Join(" ", weights.ToArray()));
        }
    }
}
