using System;
using System.Collections.Generic;
using System.Linq;
using UnityEditor;
using UnityEngine;

namespace Mua.Editor
{
    /// <summary>
    /// The fields of an AvatarRenderer, how far it has come, what is wrong, and its clip to play and to scrub through, in
    /// the scene view too while the editor does not play.
    /// </summary>
    [CustomEditor(typeof(AvatarRenderer)), CanEditMultipleObjects]
    internal sealed class AvatarRendererEditor : UnityEditor.Editor
    {
        private static readonly GUIContent Outside = new GUIContent(
            "Outside Training",
            "Share of the pose that the avatar's training did not show; 0 % is a pose like those of training.");

        private SerializedProperty clip;
        private bool showsExpressions;
        private bool previews; // the clip in the scene view; nothing of it is saved
        private double previewed; // seconds of the editor's clock

        private void OnEnable()
        {
            clip = serializedObject.FindProperty("clip");
        }

        private void OnDisable() // deselected, destroyed, or before assemblies are loaded anew
        {
            Preview(false);
        }

        public override bool RequiresConstantRepaint()
        {
            var shown = (AvatarRenderer)target;
            return previews || shown.State == AvatarState.Loading
                || (shown.State == AvatarState.Ready && Application.isPlaying);
        }

        /// <summary>The scene view asks by this name what F frames: the avatar, and not the point where it stands.</summary>
        public bool HasFrameBounds()
        {
            return targets.Cast<AvatarRenderer>().Any(shown => shown.State == AvatarState.Ready);
        }

        /// <summary>Box of all that are selected, in Unity's world, metres.</summary>
        public Bounds OnGetFrameBounds()
        {
            Bounds[] boxes = targets.Cast<AvatarRenderer>().Select(shown => shown.Bounds).ToArray();
            Bounds all = boxes[0];
            foreach (Bounds box in boxes)
            {
                all.Encapsulate(box);
            }
            return all;
        }

        /// <summary>What a click in the scene view hits, where gizmos are shown: an invisible box about the avatar.</summary>
        [DrawGizmo(GizmoType.Pickable | GizmoType.Selected | GizmoType.NonSelected)]
        internal static void DrawPickable(AvatarRenderer shown, GizmoType type)
        {
            if (shown.State == AvatarState.Ready)
            {
                Gizmos.color = Color.clear;
                Gizmos.DrawCube(shown.Bounds.center, shown.Bounds.size);
            }
        }

        public override void OnInspectorGUI()
        {
            var shown = (AvatarRenderer)target;
            bool isOne = targets.Length == 1;
            serializedObject.Update();
            DrawPropertiesExcluding(serializedObject, "m_Script", "clip");
            if (isOne && shown.Clips.Count > 0)
            {
                ChooseClip(shown.Clips);
            }
            else
            {
                EditorGUILayout.PropertyField(clip);
            }
            serializedObject.ApplyModifiedProperties();
            if (isOne)
            {
                ShowState(shown);
            }
        }

        private void ChooseClip(IReadOnlyList<string> names)
        {
            string[] clips = names.ToArray();
            int present = Mathf.Max(0, Array.IndexOf(clips, clip.stringValue));
            EditorGUI.BeginChangeCheck();
            int chosen = EditorGUILayout.Popup("Clip", present, clips);
            if (EditorGUI.EndChangeCheck())
            {
                clip.stringValue = clips[chosen];
            }
        }

        private void ShowState(AvatarRenderer shown)
        {
            if (shown.Message.Length > 0)
            {
                bool isFailed = shown.State == AvatarState.Failed;
                EditorGUILayout.HelpBox(shown.Message, isFailed ? MessageType.Error : MessageType.Warning);
            }
            if (shown.State == AvatarState.Loading)
            {
                Rect bar = EditorGUILayout.GetControlRect();
                EditorGUI.ProgressBar(bar, shown.Progress, "Loading");
            }
            if (shown.State == AvatarState.Ready && shown.FrameCount > 1 && shown.Rig == null)
            {
                Scrub(shown);
            }
            if (shown.ExpressionNames.Count > 0)
            {
                ShowExpressions(shown);
            }
            if (shown.State == AvatarState.Ready && Application.isPlaying)
            {
                EditorGUILayout.LabelField(Outside, new GUIContent((100 * shown.OutsideTraining).ToString("F0") + " %"));
            }
        }

        private void Scrub(AvatarRenderer shown)
        {
            bool plays = Application.isPlaying ? shown.IsPlaying : previews;
            if (GUILayout.Button(plays ? "Pause" : "Play"))
            {
                if (Application.isPlaying)
                {
                    shown.IsPlaying = !plays;
                }
                else
                {
                    Preview(!plays);
                }
            }
            EditorGUI.BeginChangeCheck();
            int frame = EditorGUILayout.IntSlider("Frame", shown.Frame, 0, shown.FrameCount - 1);
            if (EditorGUI.EndChangeCheck())
            {
                shown.Frame = frame;
                Redraw();
            }
        }

        /// <summary>A slider for each expression, to look at; nothing of it is saved.</summary>
        private void ShowExpressions(AvatarRenderer shown)
        {
            showsExpressions = EditorGUILayout.Foldout(showsExpressions, "Expressions");
            if (!showsExpressions)
            {
                return;
            }
            foreach (string name in shown.ExpressionNames)
            {
                EditorGUI.BeginChangeCheck();
                float weight = EditorGUILayout.Slider(name, shown.GetExpression(name), 0, 1);
                if (EditorGUI.EndChangeCheck())
                {
                    shown.SetExpression(name, weight);
                    Redraw();
                }
            }
            if (GUILayout.Button("Reset Expressions"))
            {
                shown.ResetExpressions();
                Redraw();
            }
        }

        private void Preview(bool plays)
        {
            previews = plays;
            previewed = EditorApplication.timeSinceStartup;
            EditorApplication.update -= Advance;
            if (plays)
            {
                EditorApplication.update += Advance;
            }
        }

        private void Advance()
        {
            var shown = (AvatarRenderer)target;
            if (shown == null || shown.State != AvatarState.Ready || shown.Rig != null || Application.isPlaying)
            {
                Preview(false);
                return;
            }
            double now = EditorApplication.timeSinceStartup;
            shown.Seconds += shown.Speed * (now - previewed);
            previewed = now;
            Redraw();
        }

        private static void Redraw()
        {
            EditorApplication.QueuePlayerLoopUpdate(); // outside of play nothing else runs one
            SceneView.RepaintAll();
        }
    }
}
