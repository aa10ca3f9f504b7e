// Stand-in. Source: Unity 6000.0 scripting reference, StageUtility.
namespace UnityEditor.SceneManagement
{
    public static class StageUtility
    {
        public static bool IsGameObjectRenderedByCamera(UnityEngine.GameObject gameObject, UnityEngine.Camera camera)
        {
            bool isOpened = StandIns.Stages.Opened.Contains(gameObject);
            bool showsOpened = StandIns.Stages.Opened.Count > 0 && camera.cameraType == UnityEngine.CameraType.SceneView;
            return isOpened == showsOpened;
        }
        public static void PlaceGameObjectInCurrentStage(UnityEngine.GameObject gameObject) { StandIns.Undone.Staged.Add(gameObject.name); }
    }
}

namespace StandIns
{
    /// <summary>Objects of the prefab that is open; a scene view shows them alone. Not part of Unity's API.</summary>
    public static class Stages { public static readonly System.Collections.Generic.List<UnityEngine.GameObject> Opened = new System.Collections.Generic.List<UnityEngine.GameObject>(); }
}
