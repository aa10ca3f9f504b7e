// Stand-in. Source: Unity 6000.0 scripting reference, GUI, GUILayout, GUILayoutUtility, GUIStyle,
// GUIContent: nothing is drawn.
namespace UnityEngine
{
    public enum ScaleMode { StretchToFill, ScaleAndCrop, ScaleToFit }

    public sealed class GUILayoutOption { internal GUILayoutOption() { } }

    public sealed class GUIStyle
    {
        public GUIStyle() { }
        public GUIStyle(GUIStyle other) { wordWrap = other.wordWrap; }

        public bool wordWrap { get; set; }
    }

    public class GUIContent
    {
        public GUIContent(string text) : this(text, "") { }
        public GUIContent(string text, string tooltip) { this.text = text; this.tooltip = tooltip; }

        public string text { get; set; }
        public string tooltip { get; set; }
    }

    public static class GUI
    {
        public static void DrawTexture(Rect position, Texture image, ScaleMode scaleMode) { StandIns.Gui.Write("texture", image.width + " x " + image.height); }
    }

    public static class GUILayout
    {
        public static bool Button(string text, params GUILayoutOption[] options)
        {
            StandIns.Gui.Write("button", text);
            return StandIns.Gui.Answer(text, false);
        }
        public static GUILayoutOption Width(float width) { return new GUILayoutOption(); }
        public static GUILayoutOption ExpandWidth(bool expand) { return new GUILayoutOption(); }
    }

    public static class GUILayoutUtility
    {
        public static Rect GetRect(float width, float height, params GUILayoutOption[] options) { return new Rect(0, 0, width, height); }
    }
}

namespace StandIns
{
    /// <summary>What an inspector has shown, and what its user answers. Not part of Unity's API.</summary>
    public static class Gui
    {
        public static readonly System.Collections.Generic.List<string> Lines = new System.Collections.Generic.List<string>();

        /// <summary>Answers of the user by a field's label.</summary>
        public static readonly System.Collections.Generic.Dictionary<string, object> Answers = new System.Collections.Generic.Dictionary<string, object>();

        public static bool Changed;

        public static void Write(string kind, string text) { Lines.Add(kind + " " + text); }

        public static T Answer<T>(string label, T present)
        {
            object answer;
            if (!Answers.TryGetValue(label, out answer))
                return present;
            Answers.Remove(label);
            Changed = true;
            return (T)answer;
        }
    }
}
