using System;
using System.IO;
using UnityEditor.Build;

namespace Mua.Editor
{
    /// <summary>What the editor's command line asks of a build.</summary>
    internal sealed class BuildArguments
    {
        private const string OutputWord = "-muaOutput";
        private const string DevelopmentWord = "-muaDevelopment";

        private BuildArguments(string output, bool isDevelopment)
        {
            Output = output;
            IsDevelopment = isDevelopment;
        }

        /// <summary>A full path.</summary>
        public string Output { get; }

        /// <summary>With the profiler and debug symbols.</summary>
        public bool IsDevelopment { get; }

        /// <summary>Errors: BuildFailedException where no output is named.</summary>
        public static BuildArguments Parse(string[] words)
        {
            int at = Array.IndexOf(words, OutputWord) + 1;
            string output = at > 0 && at < words.Length ? words[at] : "";
            if (output.Length == 0 || output.StartsWith("-"))
            {
                throw new BuildFailedException($"the command line has no {OutputWord} PATH, expected where to write the player");
            }
            string path = Path.GetFullPath(output).TrimEnd(Path.DirectorySeparatorChar, Path.AltDirectorySeparatorChar);
            return new BuildArguments(path, Array.IndexOf(words, DevelopmentWord) >= 0);
        }
    }
}
