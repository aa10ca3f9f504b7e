namespace Mua.Editor
{
    /// <summary>How a run ended; the number is the editor's exit code in batch mode.</summary>
    internal enum ProjectOutcome
    {
        Done = 0,
        Failed = 1,

        /// <summary>Packages or scripts were brought; the same command is to be run once more.</summary>
        Again = 3, // 2 is Unity's own, for tests
    }
}
