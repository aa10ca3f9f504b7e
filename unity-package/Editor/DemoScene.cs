using Mua.Format;
using UnityEditor;
using UnityEditor.SceneManagement;
using UnityEngine;
using UnityEngine.Rendering;
using UnityEngine.SceneManagement;

namespace Mua.Editor
{
    /// <summary>A scene with one avatar on a ground in the sun, and a camera in front of it.</summary>
    internal static class DemoScene
    {
        public const string Location = "Assets/MUA Demo.unity";

        private const string Title = "MUA Demo Scene";
        private const float Distance = 1.4f; // of the camera, times the avatar's longest side
        private const float EyeHeight = 0.6f; // of the camera, times the avatar's height
        private const float NearPlane = 0.05f; // metres: people walk up to an avatar

        private static readonly Quaternion Facing = Quaternion.Euler(0, 180, 0); // the avatar looks along +Z
        private static readonly Quaternion Sun = Quaternion.Euler(50, 150, 0); // from above and behind the camera

        /// <summary>Asks where something would be lost, makes the scene, saves it and leaves it open.</summary>
        [MenuItem("MUA/Create Demo Scene", false, 1)] // orders more than ten apart draw a line between entries
        public static void Create()
        {
            AvatarAsset asset = AvatarObject.Find();
            if (asset == null)
            {
                EditorUtility.DisplayDialog(
                    Title, "This project has no avatar yet. Copy a ." + AvatarImporter.Extension
                    + " file into its Assets folder and try again.", "OK");
                return;
            }
            if (!MayReplace() || !EditorSceneManager.SaveCurrentModifiedScenesIfUserWantsTo())
            {
                return;
            }
            Scene scene = EditorSceneManager.NewScene(NewSceneSetup.EmptyScene, NewSceneMode.Single);
            Selection.activeObject = Fill(asset);
            if (!EditorSceneManager.SaveScene(scene, Location))
            {
                Debug.LogError("MUA: the demo scene could not be saved as " + Location + ".");
            }
        }

        /// <summary>Fills the open scene; returns the avatar's GameObject.</summary>
        public static GameObject Fill(AvatarAsset asset)
        {
            float[] bounds = AvatarFile.Read(asset.Content).Bounds;
            float height = bounds[4] - bounds[1];
            float longest = Mathf.Max(height, Mathf.Max(bounds[3] - bounds[0], bounds[5] - bounds[2]));
            AddGround();
            AddSun();
            AddCamera(new Vector3(0, EyeHeight * height, Distance * longest));
            return AvatarObject.Create(asset, null, Vector3.zero);
        }

        private static bool MayReplace()
        {
            return AssetDatabase.LoadAssetAtPath<SceneAsset>(Location) == null
                || EditorUtility.DisplayDialog(Title, Location + " exists. Replace it?", "Replace", "Cancel");
        }

        private static void AddGround()
        {
            GameObject ground = GameObject.CreatePrimitive(PrimitiveType.Plane);
            ground.name = "Ground";
            RenderPipelineAsset pipeline = GraphicsSettings.currentRenderPipeline;
            if (pipeline != null)
            {
                ground.GetComponent<Renderer>().sharedMaterial = pipeline.defaultMaterial;
            }
        }

        private static void AddSun()
        {
            var sun = new GameObject("Sun").AddComponent<Light>();
            sun.type = LightType.Directional;
            sun.shadows = LightShadows.Soft;
            sun.transform.rotation = Sun;
        }

        private static void AddCamera(Vector3 position)
        {
            var camera = new GameObject("Main Camera").AddComponent<Camera>();
            camera.gameObject.tag = "MainCamera";
            camera.nearClipPlane = NearPlane;
            camera.transform.SetPositionAndRotation(position, Facing);
        }
    }
}
