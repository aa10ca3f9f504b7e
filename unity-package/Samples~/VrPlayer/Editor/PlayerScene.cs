using System;
using System.IO;
using UnityEditor;
using UnityEditor.SceneManagement;
using UnityEngine;
using UnityEngine.Rendering;
using UnityEngine.SceneManagement;

namespace Mua.Samples.VrPlayer.Editor
{
    /// <summary>Makes the player's scene: ground, light, an avatar, a user, and the two panels beside it.</summary>
    public static class PlayerScene
    {
        private const string Default = "Assets/MuaPlayer.unity";
        private const string TextShader = "Hidden/MUA/Text"; // text.shader of this sample
        private const float EyeHeight = 1.6f; // metres; of a user without a headset
        private const float Distance = 2.2f; // metres from the avatar
        private const float LetterHeight = 0.028f; // metres
        private const int LetterPixels = 64;
        private const float UnitsOfPixel = 0.1f; // TextMesh draws a font of n pixels n * 0.1 * characterSize high

        private const string Help = // what the buttons do; the sample's README.md has the same as a table
            "CONTROLLERS\n"
            + "left stick   walk\n"
            + "right stick   turn the avatar, zoom\n"
            + "right grip + stick   scrub\n"
            + "A   play, pause        B   next clip\n"
            + "right, left trigger   next, previous frame\n"
            + "Y, X   next, previous avatar\n"
            + "left grip + A B X Y right trigger\n"
            + "     splats geometry template skeleton shadow\n"
            + "left grip + left trigger   previous clip\n"
            + "right stick pressed   back to the start\n"
            + "menu, left stick pressed   hide this\n\n"
            + "KEYBOARD AND MOUSE\n"
            + "W A S D   walk        R F   up, down\n"
            + "right mouse button   look\n"
            + "Q E   turn        wheel, up, down   zoom\n"
            + "left, right   scrub        space   play, pause\n"
            + ". ,   frame     ] [   clip     page down, up   avatar\n"
            + "1 2 3 4 5   splats geometry template skeleton shadow\n"
            + "backspace   back to the start     H   hide this";

        private static readonly Color Background = new Color(0.16f, 0.17f, 0.19f);
        private static readonly Color Ground = new Color(0.45f, 0.45f, 0.45f);

        /// <summary>
        /// Writes the scene to a path in Assets, and opens it. Every imported avatar of the project is in it.
        /// </summary>
        public static void Create(string path)
        {
            Directory.CreateDirectory(Path.GetDirectoryName(path));
            AssetDatabase.Refresh();
            Scene scene = EditorSceneManager.NewScene(NewSceneSetup.EmptyScene, NewSceneMode.Single);
            AddLight();
            AddGround(Path.ChangeExtension(path, null) + "Ground.mat");
            AddUser(AddAvatar());
            if (!EditorSceneManager.SaveScene(scene, path))
            {
                throw new InvalidOperationException(path + ": the scene could not be saved; expected a path in Assets.");
            }
        }

        [MenuItem("MUA/Create VR Player Scene")]
        private static void CreateHere()
        {
            if (EditorSceneManager.SaveCurrentModifiedScenesIfUserWantsTo())
            {
                Create(Default);
            }
        }

        private static void AddLight()
        {
            var light = new GameObject("Light").AddComponent<Light>();
            light.type = LightType.Directional;
            light.shadows = LightShadows.Soft;
            light.transform.rotation = Quaternion.Euler(50, -30, 0);
        }

        private static void AddGround(string materialPath)
        {
            RenderPipelineAsset pipeline = GraphicsSettings.defaultRenderPipeline;
            var material = new Material(pipeline == null ? Shader.Find("Standard") : pipeline.defaultShader) { color = Ground };
            AssetDatabase.CreateAsset(material, materialPath);
            GameObject ground = GameObject.CreatePrimitive(PrimitiveType.Plane); // 10 m wide
            ground.name = "Ground";
            ground.GetComponent<MeshRenderer>().sharedMaterial = material;
        }

        /// <summary>The avatar faces the user.</summary>
        private static AvatarRenderer AddAvatar()
        {
            var avatar = new GameObject("Avatar").AddComponent<AvatarRenderer>();
            avatar.transform.rotation = Quaternion.Euler(0, 180, 0);
            return avatar;
        }

        private static void AddUser(AvatarRenderer avatar)
        {
            var user = new GameObject("User");
            user.transform.position = new Vector3(0, 0, -Distance);
            var head = new GameObject("Head") { tag = "MainCamera" };
            head.transform.SetParent(user.transform, false);
            head.transform.localPosition = new Vector3(0, EyeHeight, 0);
            AddCamera(head);
            TextMesh panel = AddText("Panel", "", new Vector3(-1.6f, 1.9f, 0.2f), -30);
            TextMesh help = AddText("Help", Help, new Vector3(0.7f, 1.9f, 0.2f), 30);
            user.AddComponent<VrPlayer>().Connect(avatar, head.AddComponent<HeadPose>(), panel, help.gameObject, FindAvatars());
        }

        private static void AddCamera(GameObject head)
        {
            var camera = head.AddComponent<Camera>();
            camera.clearFlags = CameraClearFlags.SolidColor;
            camera.backgroundColor = Background;
            camera.nearClipPlane = 0.05f;
            camera.farClipPlane = 100;
            camera.allowHDR = false;
            camera.allowMSAA = false;
        }

        private static TextMesh AddText(string name, string content, Vector3 position, float yaw)
        {
            var thing = new GameObject(name, typeof(MeshRenderer), typeof(TextMesh));
            thing.transform.SetPositionAndRotation(position, Quaternion.Euler(0, yaw, 0));
            TextMesh text = thing.GetComponent<TextMesh>();
            text.font = Resources.GetBuiltinResource<Font>("LegacyRuntime.ttf");
            text.fontSize = LetterPixels;
            text.characterSize = LetterHeight / (UnitsOfPixel * LetterPixels);
            text.anchor = TextAnchor.UpperLeft;
            text.text = content;
            thing.GetComponent<MeshRenderer>().sharedMaterial = text.font.material;
            thing.AddComponent<StandingText>().Connect(Shader.Find(TextShader));
            return text;
        }

        private static AvatarAsset[] FindAvatars()
        {
            string[] paths = Array.ConvertAll(
                AssetDatabase.FindAssets("t:" + nameof(AvatarAsset)), guid => AssetDatabase.GUIDToAssetPath(guid));
            Array.Sort(paths, string.CompareOrdinal);
            return Array.ConvertAll(paths, path => AssetDatabase.LoadAssetAtPath<AvatarAsset>(path));
        }
    }
}
