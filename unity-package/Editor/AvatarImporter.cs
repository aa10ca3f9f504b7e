using System;
using System.IO;
using Mua.Format;
using UnityEditor;
using UnityEditor.AssetImporters;
using UnityEngine;

namespace Mua.Editor
{
    /// <summary>
    /// Makes an AvatarAsset of a `.muaavatar` file. If the file is damaged or cannot be read, the asset
    /// says why, and an import error is logged.
    /// </summary>
    [ScriptedImporter(Version, Extension, AllowCaching = true)]
    internal sealed class AvatarImporter : ScriptedImporter
    {
        /// <summary>File extension, without the dot.</summary>
        public const string Extension = "muaavatar";

        private const int Version = 2; // raise it whenever the importer makes something else of a file
        private const string AvatarId = "avatar", ThumbnailId = "thumbnail"; // by which references find the parts

        public override void OnImportAsset(AssetImportContext ctx)
        {
            try
            {
                Add(ctx, AvatarFile.Read(File.ReadAllBytes(FileUtil.GetPhysicalPath(ctx.assetPath))));
            }
            catch (AvatarFormatException error)
            {
                AddFaulty(ctx, error.Message);
            }
            catch (Exception error) when (error is IOException || error is UnauthorizedAccessException)
            {
                AddFaulty(ctx, "the file cannot be read (" + error.Message.TrimEnd('.') + ")");
            }
        }

        private static void Add(AssetImportContext ctx, AvatarFile avatar)
        {
            Texture2D thumbnail = Thumbnail(avatar);
            AvatarAsset asset = AvatarAsset.Create(avatar.Content, thumbnail, AvatarSummary.Of(avatar));
            if (thumbnail != null)
            {
                ctx.AddObjectToAsset(ThumbnailId, thumbnail);
            }
            ctx.AddObjectToAsset(AvatarId, asset, thumbnail); // without one, the editor shows its own icon
            ctx.SetMainObject(asset);
        }

        /// <summary>The PNG that the file brings; null where it brings none, or one that is damaged.</summary>
        private static Texture2D Thumbnail(AvatarFile avatar)
        {
            var texture = new Texture2D(1, 1, TextureFormat.RGBA32, false) { name = ThumbnailId }; // loading gives its size
            if (avatar.Thumbnail.Count > 0 && texture.LoadImage(avatar.Thumbnail.ToArray()))
            {
                return texture;
            }
            DestroyImmediate(texture);
            return null;
        }

        private static void AddFaulty(AssetImportContext ctx, string fault)
        {
            AvatarAsset asset = AvatarAsset.CreateFaulty(fault);
            ctx.AddObjectToAsset(AvatarId, asset);
            ctx.SetMainObject(asset);
            ctx.LogImportError("MUA: " + ctx.assetPath + ": " + fault + ".", asset);
        }
    }

    /// <summary>An avatar's import has no settings; AvatarAssetEditor shows its result.</summary>
    [CustomEditor(typeof(AvatarImporter))]
    internal sealed class AvatarImporterEditor : ScriptedImporterEditor
    {
        protected override bool needsApplyRevert => false;

        public override void OnInspectorGUI()
        {
        }
    }

    /// <summary>Shows an avatar anew when its file has changed: a component notices only another asset.</summary>
    internal sealed class AvatarReimport : AssetPostprocessor
    {
        private static void OnPostprocessAllAssets(
            string[] importedAssets, string[] deletedAssets, string[] movedAssets, string[] movedFromAssetPaths)
        {
            foreach (string path in importedAssets)
            {
                if (Path.GetExtension(path) == "." + AvatarImporter.Extension)
                {
                    Show(path);
                }
            }
        }

        private static void Show(string path)
        {
            foreach (AvatarRenderer shown in AvatarRenderer.All())
            {
                if (shown.Avatar != null && AssetDatabase.GetAssetPath(shown.Avatar) == path)
                {
                    shown.Load(shown.Avatar);
                }
            }
        }
    }
}
