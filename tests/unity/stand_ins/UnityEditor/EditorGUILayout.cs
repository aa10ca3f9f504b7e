// Stand-in. Source: Unity 6000.0 scripting reference, EditorGUILayout, EditorGUI, EditorStyles, MessageType.
using StandIns;
using UnityEngine;

namespace UnityEditor
{
    public enum MessageType { None, Info, Warning, Error }

    public static class EditorStyles
    {
        private static readonly GUIStyle Plain = new GUIStyle(), Bold = new GUIStyle();

        public static GUIStyle label { get { return Plain; } }
        public static GUIStyle boldLabel { get { return Bold; } }
    }

    public static class EditorGUI
    {
        public static void BeginChangeCheck() { Gui.Changed = false; }
        public static bool EndChangeCheck() { return Gui.Changed; }
        public static void ProgressBar(Rect position, float value, string text) { Gui.Write("progress", text); }
    }

    public static class EditorGUILayout
    {
        public static Rect BeginHorizontal(params GUILayoutOption[] options) { return new Rect(); }
        public static void EndHorizontal() { }
        public static void Space() { Gui.Write("space", ""); }
        public static void LabelField(string label, params GUILayoutOption[] options) { Gui.Write("label", label); }
        public static void LabelField(string label, GUIStyle style, params GUILayoutOption[] options)
        {
            Gui.Write(style == EditorStyles.boldLabel ? "title" : "label", label);
        }
        public static void LabelField(GUIContent label, GUIContent label2, params GUILayoutOption[] options)
        {
            Gui.Write("value", label.text + ": " + label2.text);
        }
        public static void HelpBox(string message, MessageType type) { Gui.Write(type.ToString(), message); }
        public static Rect GetControlRect(params GUILayoutOption[] options) { return new Rect(); }
        public static bool PropertyField(SerializedProperty property, params GUILayoutOption[] options)
        {
            Gui.Write("property", property.stringValue);
            return false;
        }
        public static int Popup(string label, int selectedIndex, string[] displayedOptions, params GUILayoutOption[] options)
        {
            Gui.Write("popup", displayedOptions[selectedIndex] + " of " + string.Join(", ", displayedOptions));
            return Gui.Answer(label, selectedIndex);
        }
        public static bool Foldout(bool foldout, string content)
        {
            Gui.Write("foldout", content);
            return Gui.Answer(content, foldout);
        }
        public static float Slider(string label, float value, float leftValue, float rightValue, params GUILayoutOption[] options)
        {
            Gui.Write("slider", label + " " + value.ToString("R") + " of " + leftValue + " to " + rightValue);
            return Gui.Answer(label, value);
        }
        public static int IntSlider(string label, int value, int leftValue, int rightValue, params GUILayoutOption[] options)
        {
            Gui.Write("slider", value + " of " + leftValue + " to " + rightValue);
            return Gui.Answer(label, value);
        }
    }
}
