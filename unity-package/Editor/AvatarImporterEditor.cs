using UnityEditor;
using UnityEditor.AssetImporters;

namespace Mua.Editor
{
    /// <summary>An avatar's import has no settings; AvatarAssetEditor shows what came of it.</summary>
    [CustomEditor(typeof(AvatarImporter))]
    internal sealed class AvatarImporterEditor : ScriptedImporterEditor
    {
        protected override bool needsApplyRevert => false;

        public override void OnInspectorGUI()
        {
        }
    }
}
