// Stand-in. Source: Unity 6000.0 scripting reference, AssetPostprocessor, whose messages are static and found by name.
namespace UnityEditor
{
    public class AssetPostprocessor { }
}
