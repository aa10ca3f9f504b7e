using UnityEditor;
using UnityEngine;

namespace Mua.Editor
{
    /// <summary>The package's menu items.</summary>
    internal static class Menus
    {
        private const string Root = "MUA/";
        private const int First = 1, Later = 20, Last = 40; // a gap of more than ten draws a line between groups
        private const int GameObjectOrder = 10; // among the kinds of objects

        [MenuItem(Root + "Create Demo Scene", false, First)]
        private static void CreateDemoScene()
        {
            DemoScene.Create();
        }

        [MenuItem(Root + "Set Up Project for Quest", false, Later)]
        private static void SetUpQuest()
        {
            ProjectSetup.Quest();
        }

        [MenuItem(Root + "Set Up Project for PC Link", false, Later + 1)]
        private static void SetUpPcLink()
        {
            ProjectSetup.PcLink();
        }

        [MenuItem(Root + "Check Project", false, Later + 2)]
        private static void CheckProject()
        {
            ProjectSetup.Tell();
        }

        [MenuItem(Root + "Run Self-Test", false, Last)]
        private static void RunSelfTest()
        {
            SelfTestCommand.Execute();
        }

        [MenuItem("GameObject/MUA Avatar", false, GameObjectOrder)]
        private static void CreateAvatar(MenuCommand command)
        {
            var parent = command.context as GameObject;
            Transform below = parent == null ? null : parent.transform;
            Vector3 at = parent == null ? Vector3.zero : below.position;
            Selection.activeObject = AvatarObject.Create(AvatarObject.Find(), below, at);
        }
    }
}
