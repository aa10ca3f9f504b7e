// Stand-in. Source: Unity 6000.0 scripting reference, SceneManagement.Scene.
namespace UnityEngine.SceneManagement
{
    public struct Scene
    {
        public string name { get; set; }
        public string path { get { return ""; } }
        public bool IsValid() { return true; }
    }
}
