// Runs the assembly Mua.Avatar.Editor over the stand-ins. Arguments: the folder of the kernels, the story, files. It prints
// what tests/unity/test_importer.py asks about.
using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Reflection;
using Mua.Format;
using StandIns;
using UnityEditor;
using UnityEngine;

namespace Mua.Editor
{
    internal static partial class ImporterProgram
    {
        private const BindingFlags Hidden = BindingFlags.Static | BindingFlags.NonPublic;

        private static string[] files;

        public static int Main(string[] arguments)
        {
            CultureInfo.CurrentCulture = CultureInfo.InvariantCulture;
            Machine.Playing(false);
            PackageResources.Place(arguments[0]);
            files = arguments.Skip(2).ToArray();
            typeof(ImporterProgram).GetMethod(arguments[1], Hidden).Invoke(null, null);
            foreach (KeyValuePair<LogType, string> line in StandIns.Console.Lines)
            {
                Say("log", line.Key, line.Value);
            }
            return 0;
        }

        private static void Imports()
        {
            foreach (string file in files)
            {
                var import = new Import(new AvatarImporter(), file);
                var asset = (AvatarAsset)import.Main;
                string icon = import.Icon == null ? "" : import.Icon.width + " x " + import.Icon.height;
                Say("asset", asset.name, asset.Content.Length, asset.Fault, string.Join(" ", import.Parts), icon);
                Say("error", string.Join(" | ", import.Errors));
                Say("summary", asset.Summary.Split('\n')[0]);
                Say("textures", Textures.Alive, import.Icon == null ? 0 : import.Icon.mipmapCount);
            }
        }

        /// <summary>A file inside a package, which lies in the project's cache.</summary>
        private static void ImportsFromPackage()
        {
            Mounted.Packages["com.someone.people"] = Path.GetDirectoryName(files[0]);
            files[0] = "Packages/com.someone.people/" + Path.GetFileName(files[0]);
            Imports();
        }

        /// <summary>Bytes and thumbnail of what is imported are those of the file.</summary>
        private static void Keeps()
        {
            var import = new Import(new AvatarImporter(), files[0]);
            var asset = (AvatarAsset)import.Main;
            byte[] content = File.ReadAllBytes(files[0]);
            AvatarFile avatar = AvatarFile.Read(content);
            Say("content", asset.Content.SequenceEqual(content));
            Say("summary", asset.Summary == AvatarSummary.Of(avatar));
            Say("thumbnail", asset.Thumbnail != null && Textures.Content(asset.Thumbnail).SequenceEqual(avatar.Thumbnail));
        }

        private static void HasNoAvatar()
        {
            Menu("MUA/Create Demo Scene");
            Tell();
        }

        private static void MakesScene()
        {
            Place(files);
            Menu("MUA/Create Demo Scene");
            Tell();
        }

        private static void KeepsScene()
        {
            Place(files);
            Project.Assets[DemoScene.Location] = new SceneAsset();
            Dialogs.Answer = false;
            Menu("MUA/Create Demo Scene");
            Tell();
        }

        private static void MakesObject()
        {
            Place(files);
            var parent = new GameObject("parent");
            parent.transform.position = new Vector3(1, 2, 3);
            Menu("GameObject/MUA Avatar", new MenuCommand(parent));
            Tell();
        }

        private static void MakesTwins()
        {
            Place(files);
            var parent = new GameObject("parent");
            Menu("GameObject/MUA Avatar", new MenuCommand(null));
            Menu("GameObject/MUA Avatar", new MenuCommand(null));
            Menu("GameObject/MUA Avatar", new MenuCommand(parent));
            Tell();
        }

        private static void Drops()
        {
            Place(files);
            typeof(AvatarObject).GetMethod("Register", Hidden).Invoke(null, null);
            AvatarAsset asset = AvatarObject.Find();
            Say("hover", Drag.Drop(new Vector3(1, 0, 2), false, asset), UnityEngine.Object.FindObjectsByType<AvatarRenderer>(FindObjectsSortMode.None).Length);
            Say("other", Drag.Drop(new Vector3(1, 0, 2), true, asset.Thumbnail), Drag.Drop(new Vector3(1, 0, 2), true, asset, asset));
            Say("drop", Drag.Drop(new Vector3(1, 0, 2), true, asset));
            Tell();
        }

        /// <summary>Upon a row of the Hierarchy, between the rows of its children, and below all rows.</summary>
        private static void DropsOnRows()
        {
            Place(files);
            typeof(AvatarObject).GetMethod("Register", Hidden).Invoke(null, null);
            AvatarAsset asset = AvatarObject.Find();
            var row = new GameObject("row");
            row.transform.position = new Vector3(3, 0, 0);
            foreach (string way in new[] { "upon", "between", "nothing", "prefab" })
            {
                Transform made = Selection.activeObject is GameObject last ? last.transform : null;
                GameObject target = way == "upon" ? row : way == "between" ? made.gameObject : null;
                Transform above = way == "prefab" ? row.transform : null;
                Say("drop", Drag.DropOnRow(target, way == "upon", above, asset));
                made = ((GameObject)Selection.activeObject).transform;
                Say("parent", made.parent == null ? "none" : made.parent.name, made.position.x);
            }
            Say("other", Drag.DropOnRow(row, true, null, asset.Thumbnail));
        }

        /// <summary>What F frames of one and of two avatars, and what a click may hit; none of it before there is an avatar.</summary>
        private static void IsFramed()
        {
            Place(files);
            AvatarAsset asset = AvatarObject.Find();
            AvatarRenderer first = AvatarObject.Create(asset, null, Vector3.zero).GetComponent<AvatarRenderer>();
            AvatarRenderer second = AvatarObject.Create(asset, null, new Vector3(5, 0, 0)).GetComponent<AvatarRenderer>();
            PlayerLoop.Frame(1);
            Say("one", Inspectors.Open<AvatarRendererEditor>(first).OnGetFrameBounds().Equals(first.Bounds), first.Bounds.size.y > 0);
            Bounds both = Inspectors.Open<AvatarRendererEditor>(first, second).OnGetFrameBounds();
            Say("both", both.Contains(first.Bounds.center), both.Contains(second.Bounds.center));
            AvatarRendererEditor.DrawPickable(second, GizmoType.NonSelected);
            Say("clicked", Gizmos.Cubes.Count, Gizmos.Cubes[0].Equals(second.Bounds));
            var empty = new GameObject("empty").AddComponent<AvatarRenderer>();
            AvatarRendererEditor.DrawPickable(empty, GizmoType.NonSelected);
            Say("empty", Gizmos.Cubes.Count, Inspectors.Open<AvatarRendererEditor>(empty).HasFrameBounds());
        }

        /// <summary>An avatar of an opened prefab and one of the scene, to the cameras of either.</summary>
        private static void OpensPrefab()
        {
            Place(files);
            AvatarAsset asset = AvatarObject.Find();
            AvatarRenderer opened = AvatarObject.Create(asset, null, Vector3.zero).GetComponent<AvatarRenderer>();
            Camera view = new GameObject("view").AddComponent<Camera>(), game = new GameObject("game").AddComponent<Camera>();
            view.cameraType = CameraType.SceneView;
            view.transform.position = game.transform.position = new Vector3(0, 1, -5);
            Stages.Opened.Add(opened.gameObject);
            SeenBy(view, game);
            SayShadow();
            AvatarRenderer other = AvatarObject.Create(asset, null, new Vector3(0.5f, 0, 0)).GetComponent<AvatarRenderer>();
            SeenBy(view, game);
            SayShadow();
            opened.Views = AvatarViews.Splats | AvatarViews.Template;
            SeenBy(view, game);
            Stages.Opened.Clear();
            SeenBy(view, game);
            UnityEditor.SceneVisibilityManager.instance.Hide(other.gameObject, false);
            SayShadow();
            UnityEditor.SceneVisibilityManager.instance.Hide(opened.gameObject, false);
            SeenBy(view, game);
            UnityEditor.SceneVisibilityManager.instance.ShowAll();
            UnityEngine.Object.DestroyImmediate(opened.gameObject);
            UnityEngine.Object.DestroyImmediate(other.gameObject);
        }

        /// <summary>Where the shadow falls of the avatar that was made last, which is decoded.</summary>
        private static void SayShadow()
        {
            PlayerLoop.Frame(1);
            Say("shadow", Recorder.LastRender.overrideSceneCullingMask, Recorder.LastRender.sceneCullingMask);
        }

        /// <summary>Draws of each camera, and splats of the avatars that it shows.</summary>
        private static void SeenBy(params Camera[] cameras)
        {
            PlayerLoop.Frame(1);
            foreach (Camera camera in cameras)
            {
                int draws = Recorder.Draws;
                camera.Render();
                draws = Recorder.Draws - draws;
                Say("seen", camera.name, draws, draws == 0 ? 0 : AvatarWorld.Current.SplatCount);
            }
        }

        private static void Selects()
        {
            Place(files);
            Selection.activeObject = Project.Assets["Assets/" + Path.GetFileName(files[1])];
            Say("found", AvatarObject.Find().name);
        }

        /// <summary>The first file's place is taken by the second one, which two components show.</summary>
        private static void Reimports()
        {
            Place(files);
            AvatarAsset asset = AvatarObject.Find();
            AvatarRenderer shown = AvatarObject.Create(asset, null, Vector3.zero).GetComponent<AvatarRenderer>();
            AvatarRenderer twin = AvatarObject.Create(asset, null, Vector3.zero).GetComponent<AvatarRenderer>();
            Say("name", shown.AvatarName, twin.AvatarName);
            FieldInfo content = typeof(AvatarAsset).GetField("content", BindingFlags.Instance | BindingFlags.NonPublic);
            content.SetValue(asset, File.ReadAllBytes(files[1])); // as Unity fills the object that it has
            object[] paths = { new[] { "Assets/other.txt", AssetDatabase.GetAssetPath(asset) }, null, null, null };
            typeof(AvatarReimport).GetMethod("OnPostprocessAllAssets", Hidden).Invoke(null, paths);
            Say("name", shown.AvatarName, twin.AvatarName);
            UnityEngine.Object.DestroyImmediate(shown.gameObject);
            UnityEngine.Object.DestroyImmediate(twin.gameObject);
            Say("alive", Recorder.AliveCount);
        }

        private static void Menus()
        {
            foreach (MenuItem item in Items().Keys)
            {
                Say("menu", item.menuItem);
            }
        }

        private static void Place(string[] paths)
        {
            foreach (string path in paths)
            {
                Project.Assets["Assets/" + Path.GetFileName(path)] = new Import(new AvatarImporter(), path).Main;
            }
        }

        private static Dictionary<MenuItem, MethodInfo> Items()
        {
            var items = new Dictionary<MenuItem, MethodInfo>();
            foreach (Type type in typeof(AvatarImporter).Assembly.GetTypes())
            {
                foreach (MethodInfo method in type.GetMethods(Hidden | BindingFlags.Public | BindingFlags.DeclaredOnly))
                {
                    foreach (MenuItem item in method.GetCustomAttributes(typeof(MenuItem), false))
                    {
                        items.Add(item, method);
                    }
                }
            }
            return items;
        }

        private static void Menu(string name, params object[] arguments)
        {
            Items().Single(item => item.Key.menuItem == name).Value.Invoke(null, arguments);
        }

        /// <summary>What is in the scene, and what the user was asked.</summary>
        private static void Tell()
        {
            foreach (GameObject thing in UnityEngine.Object.FindObjectsByType<Transform>(FindObjectsSortMode.None).Select(at => at.gameObject))
            {
                Vector3 at = thing.transform.position, ahead = thing.transform.forward;
                string kinds = string.Join(" ", thing.GetComponentsInChildren<Component>().Where(c => c.gameObject == thing).Skip(1).Select(c => c.GetType().Name));
                Say("object", thing.name, kinds, at.x, at.y, at.z, ahead.x, ahead.y, ahead.z, thing.transform.parent == null ? "" : thing.transform.parent.name);
            }
            foreach (AvatarRenderer shown in UnityEngine.Object.FindObjectsByType<AvatarRenderer>(FindObjectsSortMode.None))
            {
                Say("shows", shown.Avatar == null ? "" : shown.Avatar.name);
            }
            Say("selected", Selection.activeObject == null ? "" : Selection.activeObject.name);
            Dialogs.Shown.ForEach(message => Say("dialog", message));
            Undone.Created.ForEach(name => Say("undo", name));
            Undone.Staged.ForEach(name => Say("staged", name));
            Scenes.Saved.ForEach(path => Say("saved", path));
        }

        private static void Say(string key, params object[] values)
        {
            System.Console.WriteLine(key + "\t" + string.Join("\t", values));
        }
    }
}
