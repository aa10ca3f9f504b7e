// Stand-in. Source: Unity 6000.0, Modules/PackageManager: Client.cs, Request.cs, Error.cs; PackageSample.cs,
// PackageInfo. A test answers.
using System;
using System.Collections.Generic;

namespace UnityEditor.PackageManager
{
    public enum StatusCode { InProgress, Success, Failure }

    public class Error { public string message { get; set; } }

    public sealed class PackageInfo
    {
        public string resolvedPath { get; internal set; }

        public static PackageInfo FindForAssembly(System.Reflection.Assembly assembly)
        {
            return StandIns.Packages.Folder == null ? null : new PackageInfo { resolvedPath = StandIns.Packages.Folder };
        }
    }

    public static class Client
    {
        public static Requests.AddAndRemoveRequest AddAndRemove(string[] packagesToAdd = null, string[] packagesToRemove = null)
        {
            StandIns.Packages.Asked.AddRange(packagesToAdd);
            return new Requests.AddAndRemoveRequest();
        }
    }
}

namespace UnityEditor.PackageManager.Requests
{
    public abstract class Request
    {
        private int polled;

        public bool IsCompleted { get { return ++polled > StandIns.Packages.Polls; } }
        public StatusCode Status
        {
            get { return polled <= StandIns.Packages.Polls ? StatusCode.InProgress : Error == null ? StatusCode.Success : StatusCode.Failure; }
        }
        public Error Error
        {
            get { return StandIns.Packages.Refusal == null ? null : new Error { message = StandIns.Packages.Refusal }; }
        }
    }

    public sealed class AddAndRemoveRequest : Request { }
}

namespace UnityEditor.PackageManager.UI
{
    public struct Sample
    {
        [Flags]
        public enum ImportOptions { None = 0, OverridePreviousImports = 1, HideImportWindow = 2 }

        public string displayName { get; internal set; }
        public string importPath { get; internal set; }
        public bool isImported { get { return StandIns.Packages.Imported; } }
        public bool Import(ImportOptions options = ImportOptions.None) { return StandIns.Packages.Imported = true; }
        public static IEnumerable<Sample> FindByPackage(string packageName, string packageVersion)
        {
            string path = "Assets/Samples/MUA Avatar/0.1.0/";
            foreach (string name in StandIns.Packages.Samples)
                yield return new Sample { displayName = name, importPath = path + name };
        }
    }
}

namespace StandIns
{
    /// <summary>What the Package Manager was asked, and its answers. Not part of Unity's API.</summary>
    public static class Packages
    {
        public static readonly List<string> Asked = new List<string>();
        public static readonly List<string> Samples = new List<string> { "VR Player" };
        public static int Polls = 2; // until a request is done
        public static string Refusal;
        public static string Folder; // of the package; null where scripts are in no package
        public static bool Imported;
    }
}
