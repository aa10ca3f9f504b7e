// Stand-in. Source: Unity 6000.0, EditorSceneManager.cs, SceneManagement.Scene; one scene, saved by name only.
using System.Collections.Generic;
using UnityEngine.SceneManagement;

namespace UnityEditor.SceneManagement
{
    public enum NewSceneSetup { EmptyScene, DefaultGameObjects }
    public enum NewSceneMode { Single, Additive }

    public static class EditorSceneManager
    {
        public static Scene NewScene(NewSceneSetup setup, NewSceneMode mode) { return new Scene(); }
        public static bool SaveScene(Scene scene, string dstScenePath)
        {
            bool inProject = dstScenePath.StartsWith("Assets/");
            if (inProject)
                StandIns.Scenes.Saved.Add(dstScenePath);
            return inProject;
        }
        public static bool SaveCurrentModifiedScenesIfUserWantsTo() { return true; }
    }
}

namespace StandIns
{
    /// <summary>Paths that scenes were saved to. Not part of Unity's API.</summary>
    public static class Scenes
    {
        public static readonly List<string> Saved = new List<string>();
    }
}
