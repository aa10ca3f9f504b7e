// Stand-in. Source: Unity 6000.0 scripting reference, Editor, CustomEditor, SerializedObject, SerializedProperty (by reflection).
using System;
using System.Collections.Generic;
using System.Reflection;
using Object = UnityEngine.Object;

namespace UnityEditor
{
    [AttributeUsage(AttributeTargets.Class)]
    public sealed class CustomEditor : Attribute { public CustomEditor(Type inspectedType) { } }

    [AttributeUsage(AttributeTargets.Class)]
    public sealed class CanEditMultipleObjects : Attribute { }

    public class Editor : UnityEngine.ScriptableObject
    {
        public Object target { get; set; }
        public Object[] targets { get; internal set; }
        public SerializedObject serializedObject { get; internal set; }

        public virtual void OnInspectorGUI() { }
        public virtual bool RequiresConstantRepaint() { return false; }
        protected internal static void DrawPropertiesExcluding(SerializedObject obj, params string[] propertyToExclude) { }
    }

    public sealed class SerializedObject
    {
        private readonly Object edited;
        private readonly List<SerializedProperty> found = new List<SerializedProperty>();

        public SerializedObject(Object obj) { edited = obj; }

        public void Update() { }
        public bool ApplyModifiedProperties()
        {
            foreach (SerializedProperty each in found)
                each.Apply();
            return true;
        }
        public bool ApplyModifiedPropertiesWithoutUndo() { return ApplyModifiedProperties(); }
        public SerializedProperty FindProperty(string propertyPath)
        {
            FieldInfo field = edited.GetType().GetField(propertyPath, BindingFlags.Instance | BindingFlags.NonPublic | BindingFlags.Public);
            if (field == null)
                return null;
            found.Add(new SerializedProperty(edited, field));
            return found[found.Count - 1];
        }
    }

    public sealed class SerializedProperty
    {
        private readonly Object edited;
        private readonly FieldInfo field;

        private object value; // until it is applied

        internal SerializedProperty(Object edited, FieldInfo field)
        {
            this.edited = edited;
            this.field = field;
            value = field.GetValue(edited);
        }

        public bool boolValue { get { return (bool)value; } set { this.value = value; } }
        public string stringValue { get { return (string)value; } set { this.value = value; } }

        internal void Apply() { field.SetValue(edited, value); }
    }
}

namespace StandIns
{
    /// <summary>Opens an inspector. Not part of Unity's API.</summary>
    public static class Inspectors
    {
        public static T Open<T>(params Object[] edited) where T : UnityEditor.Editor
        {
            T made = (T)Activator.CreateInstance(typeof(T), true);
            made.target = edited[0];
            made.targets = edited;
            made.serializedObject = new UnityEditor.SerializedObject(edited[0]);
            Messages.Send(made, "OnEnable");
            return made;
        }
    }
}
