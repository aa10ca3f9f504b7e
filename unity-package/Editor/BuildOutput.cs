using System;
using System.IO;
using System.Linq;
using UnityEditor;
using UnityEditor.Build;

namespace Mua.Editor
{
    /// <summary>
    /// Where a build goes: made in a folder beside it, and moved under its own name only when it is whole. Nothing older is
    /// left from Prepare on, so that what is there is always this build's.
    /// </summary>
    internal abstract class BuildOutput
    {
        private const string Extension = ".apk";
        private const string Program = "mua-player.exe";

        private BuildOutput(string path)
        {
            Path = path;
        }

        /// <summary>Of the whole build; a folder on Windows.</summary>
        public string Path { get; }

        /// <summary>What Unity is to write; other files that it leaves beside it go with Discard.</summary>
        public abstract string Unfinished { get; }

        protected string Part => Path + ".part";

        /// <summary>Errors: BuildFailedException where the path is none for the platform.</summary>
        public static BuildOutput Of(BuildTarget target, string path)
        {
            return target == BuildTarget.Android ? (BuildOutput)new Apk(path) : new Folder(path);
        }

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

        /// <summary>Gives the build its name.</summary>
        public abstract void Finish();

        /// <summary>Removes what is not whole.</summary>
        public void Discard()
        {
            Remove(Part);
        }

        /// <summary>Bytes of the whole build.</summary>
        public abstract long Size();

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

        private sealed class Apk : BuildOutput
        {
            public Apk(string path) : base(path)
            {
                if (!path.EndsWith(Extension, StringComparison.Ordinal))
                {
                    throw new BuildFailedException($"-muaOutput is {path}, expected a file name that ends in {Extension}");
                }
                if (Directory.Exists(path))
                {
                    throw new BuildFailedException($"-muaOutput is {path}, which is a folder, expected a file name");
                }
            }

            public override string Unfinished => System.IO.Path.Combine(Part, System.IO.Path.GetFileName(Path));

            public override void Finish()
            {
                File.Move(Unfinished, Path);
            }

            public override long Size()
            {
                return new FileInfo(Path).Length;
            }
        }

        private sealed class Folder : BuildOutput
        {
            public Folder(string path) : base(path)
            {
                bool isOther = Directory.Exists(path) && Directory.EnumerateFileSystemEntries(path).Any()
                    && !File.Exists(System.IO.Path.Combine(path, Program));
                if (isOther || File.Exists(path))
                {
                    throw new BuildFailedException(
                        $"-muaOutput is {path}, which holds something else than the player, expected a new folder's name");
                }
            }

            public override string Unfinished => System.IO.Path.Combine(Part, Program);

            public override void Finish()
            {
                Directory.Move(Part, Path);
            }

            public override long Size()
            {
                return new DirectoryInfo(Path).EnumerateFiles("*", SearchOption.AllDirectories).Sum(file => file.Length);
            }
        }
    }
}
