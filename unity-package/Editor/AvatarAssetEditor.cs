using System;
using UnityEditor;
using UnityEngine;

namespace Mua.Editor
{
    /// <summary>Shows what an imported avatar holds, as `mua-inspect` prints it, or why it cannot be shown.</summary>
    [CustomEditor(typeof(AvatarAsset))]
    internal sealed class AvatarAssetEditor : UnityEditor.Editor
    {
        private const float Picture = 128; // pixels
        private const float Column = 110; // pixels of each cell but the last one

        private string[][] rows = new string[0][];
        private GUIStyle wrapped;

        private void OnEnable()
        {
            string[] lines = ((AvatarAsset)target).Summary.TrimEnd('\n').Split('\n');
            rows = Array.ConvertAll(lines, line => line.Split('\t'));
        }

        public override void OnInspectorGUI()
        {
            var asset = (AvatarAsset)target;
            if (asset.Fault.Length > 0)
            {
                EditorGUILayout.HelpBox(asset.Fault + ".", MessageType.Error);
                return;
            }
            if (asset.Thumbnail != null)
            {
                Rect place = GUILayoutUtility.GetRect(Picture, Picture, GUILayout.ExpandWidth(false));
                GUI.DrawTexture(place, asset.Thumbnail, ScaleMode.ScaleToFit);
            }
            if (wrapped == null)
            {
                wrapped = new GUIStyle(EditorStyles.label) { wordWrap = true };
            }
            bool isTitle = true;
            foreach (string[] cells in rows)
            {
                Draw(cells, isTitle);
                isTitle = IsEmpty(cells);
            }
        }

        private void Draw(string[] cells, bool isTitle)
        {
            if (IsEmpty(cells))
            {
                EditorGUILayout.Space();
                return;
            }
            EditorGUILayout.BeginHorizontal();
            for (int i = 0; i < cells.Length - 1; i++)
            {
                EditorGUILayout.LabelField(cells[i], GUILayout.Width(Column));
            }
            EditorGUILayout.LabelField(cells[cells.Length - 1], isTitle ? EditorStyles.boldLabel : wrapped);
            EditorGUILayout.EndHorizontal();
        }

        private static bool IsEmpty(string[] cells)
        {
            return cells.Length == 1 && cells[0].Length == 0;
        }
    }
}
