// What a test may set of the program that Unity runs in.
namespace StandIns
{
    /// <summary>How Unity was started. Not part of its API.</summary>
    public static class Process { public static bool IsBatchMode = true; }
}
