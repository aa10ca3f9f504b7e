// Stand-in. Source: Unity 6000.0 scripting reference, StageUtility, SceneVisibilityManager, SceneCullingMasks.
namespace UnityEditor.SceneManagement
{
    public static class SceneCullingMasks
    {
        public const ulong GameViewObjects = 1UL << 63;
    }

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

namespace UnityEditor
{
    public class ScriptableSingleton<T> where T : class, new()
    {
        public static T instance { get; } = new T();
    }

    public class SceneVisibilityManager : ScriptableSingleton<SceneVisibilityManager>
    {
        private UnityEngine.GameObject hidden;

        public void Hide(UnityEngine.GameObject gameObject, bool includeDescendants) { hidden = gameObject; }
        public void ShowAll() { hidden = null; }
        public bool IsHidden(UnityEngine.GameObject gameObject, bool includeDescendants = false) { return hidden == gameObject; }
    }
}
