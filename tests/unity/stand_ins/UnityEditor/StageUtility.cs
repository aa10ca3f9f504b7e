// Stand-in. Source: Unity 6000.0 scripting reference, StageUtility.
namespace UnityEditor.SceneManagement
{
    public static class StageUtility { public static void PlaceGameObjectInCurrentStage(UnityEngine.GameObject gameObject) { StandIns.Undone.Staged.Add(gameObject.name); } }
}
