// Stand-in. Source: Unity 6000.0 scripting reference, EditorApplication.
namespace UnityEditor
{
    public static class EditorApplication
    {
        public delegate void CallbackFunction();

        public static CallbackFunction update;
        public static CallbackFunction delayCall;

        public static double timeSinceStartup { get { return UnityEngine.Time.timeAsDouble; } }
        public static bool isPlayingOrWillChangePlaymode { get { return false; } }
        public static void QueuePlayerLoopUpdate() { StandIns.Asked.Updates++; }
        public static void Exit(int returnValue) { throw new System.OperationCanceledException("exit " + returnValue); }
    }
}
