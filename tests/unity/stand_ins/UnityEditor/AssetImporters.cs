// Stand-in. Source: Unity 6000.0; FileUtil.bindings.cs, ScriptedImporter.cs, AssetImportContext, AssetImporterEditor.cs.
using System;
using System.Collections.Generic;
using UnityEngine;

namespace UnityEditor
{
    public static class FileUtil { public static string GetPhysicalPath(string logicalPath) { return StandIns.Mounted.Path(logicalPath); } }
    public class AssetImporter : UnityEngine.Object { public string assetPath { get; internal set; } }
}

namespace UnityEditor.AssetImporters
{
    [AttributeUsage(AttributeTargets.Class, Inherited = false)]
    public class ScriptedImporterAttribute : Attribute
    {
        public bool AllowCaching;

        public ScriptedImporterAttribute(int version, string ext) { }
    }

    public abstract class ScriptedImporter : AssetImporter { public abstract void OnImportAsset(AssetImportContext ctx); }

    public class AssetImportContext
    {
        internal readonly Dictionary<string, UnityEngine.Object> Parts = new Dictionary<string, UnityEngine.Object>();
        internal readonly List<string> Errors = new List<string>();
        internal Texture2D Icon;

        internal AssetImportContext(string path) { assetPath = path; }

        public string assetPath { get; private set; }
        public UnityEngine.Object mainObject { get; private set; }

        public void AddObjectToAsset(string identifier, UnityEngine.Object obj) { Parts.Add(identifier, obj); }
        public void AddObjectToAsset(string identifier, UnityEngine.Object obj, Texture2D thumbnail)
        {
            Icon = thumbnail;
            Parts.Add(identifier, obj);
        }
        public void SetMainObject(UnityEngine.Object obj)
        {
            if (!Parts.ContainsValue(obj))
                throw new InvalidOperationException("the main object was not added to the asset");
            mainObject = obj;
            obj.name = System.IO.Path.GetFileNameWithoutExtension(assetPath);
        }
        public void LogImportError(string msg, UnityEngine.Object obj = null) { Errors.Add(msg); }
    }

    public abstract class AssetImporterEditor : Editor
    {
        protected virtual bool needsApplyRevert { get { return true; } }
    }

    public class ScriptedImporterEditor : AssetImporterEditor { }
}

namespace StandIns
{
    using UnityEditor.AssetImporters;

    /// <summary>Where packages lie, by their names; the editor's paths say Packages/NAME wherever that is. Not part of Unity's API.</summary>
    public static class Mounted
    {
        public static readonly Dictionary<string, string> Packages = new Dictionary<string, string>();

        internal static string Path(string path)
        {
            string[] parts = path.Split(new[] { '/' }, 3);
            string folder;
            return parts.Length == 3 && parts[0] == "Packages" && Packages.TryGetValue(parts[1], out folder)
                ? System.IO.Path.Combine(folder, parts[2])
                : path;
        }
    }

    /// <summary>Imports a file as Unity does. Not part of Unity's API.</summary>
    public sealed class Import
    {
        private readonly AssetImportContext context;

        public Import(ScriptedImporter importer, string path)
        {
            context = new AssetImportContext(path);
            importer.OnImportAsset(context);
        }

        public UnityEngine.Object Main { get { return context.mainObject; } }
        public Texture2D Icon { get { return context.Icon; } }
        public List<string> Errors { get { return context.Errors; } }
        public ICollection<string> Parts { get { return context.Parts.Keys; } }
    }
}
