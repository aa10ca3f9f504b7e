using System;
using System.IO;
using System.Linq;
using UnityEditor;
using UnityEditor.Build;

namespace Mua.Editor
{
    /// <summary>
    /// Where a build goes, an APK or a folder for Windows: made in a folder beside it, and moved under its own name
    /// only when it is complete. Nothing older is left from Prepare on, so that what is there is always this build's.
    /// </summary>
    internal sealed class BuildOutput
    {
        private const string Extension = ".apk";
        private const string Program = "mua-player.exe";

        private readonly bool isFile;

        /// <summary>Errors: BuildFailedException where the path is none for the platform.</summary>
        public BuildOutput(BuildTarget target, string path)
        {
            Path = path;
            isFile = target == BuildTarget.Android;
            string fault = isFile ? FileFault() : FolderFault();
            if (fault != null)
            {
                throw new BuildFailedException($"-muaOutput is {path}, {fault}");
            }
        }

        /// <summary>Path of the finished build.</summary>
        public string Path { get; }

        /// <summary>Path that Unity writes to; Discard removes it with all files beside it.</summary>
        public string Unfinished => System.IO.Path.Combine(Part, isFile ? System.IO.Path.GetFileName(Path) : Program);

        private string Part => Path + ".part";

        /// <summary>Removes what is older and tries that it can be written. Errors: BuildFailedException.</summary>
        public void Prepare()
        {
            try
            {
                string above = System.IO.Path.GetDirectoryName(Path);
                Directory.CreateDirectory(above);
                string trial = System.IO.Path.Combine(above, System.IO.Path.GetRandomFileName());
                File.WriteAllBytes(trial, new byte[0]);
                File.Delete(trial);
                Remove(Path);
                Discard();
            }
            catch (Exception error) when (error is IOException || error is UnauthorizedAccessException)
            {
                throw new BuildFailedException($"-muaOutput is {Path}, which cannot be written: {error.Message}");
            }
        }

        /// <summary>Moves the finished build to Path.</summary>
        public void Finish()
        {
            if (isFile)
            {
                File.Move(Unfinished, Path);
            }
            else
            {
                Directory.Move(Part, Path);
            }
        }

        /// <summary>Removes an unfinished build.</summary>
        public void Discard()
        {
            Remove(Part);
        }

        /// <summary>Size of the finished build, bytes.</summary>
        public long Size()
        {
            return isFile
                ? new FileInfo(Path).Length
                : new DirectoryInfo(Path).EnumerateFiles("*", SearchOption.AllDirectories).Sum(file => file.Length);
        }

        private string FileFault()
        {
            if (!Path.EndsWith(Extension, StringComparison.Ordinal))
            {
                return $"expected a file name that ends in {Extension}";
            }
            return Directory.Exists(Path) ? "which is a folder, expected a file name" : null;
        }

        private string FolderFault()
        {
            bool isOther = Directory.Exists(Path) && Directory.EnumerateFileSystemEntries(Path).Any()
                && !File.Exists(System.IO.Path.Combine(Path, Program));
            return isOther || File.Exists(Path)
                ? "which holds something else than the player, expected a new folder's name"
                : null;
        }

        private static void Remove(string path)
        {
            if (Directory.Exists(path))
            {
                Directory.Delete(path, true);
            }
            else
            {
                File.Delete(path);
            }
        }
    }
}
