using UnityEditor;
using UnityEngine;

namespace Mua.Editor
{
    /// <summary>Dropping an imported avatar into the scene view puts it there.</summary>
    internal static class AvatarDrop
    {
        [InitializeOnLoadMethod]
        private static void Register()
        {
#if UNITY_6000_3_OR_NEWER
            DragAndDrop.AddDropHandlerV2(Drop);
#else
            DragAndDrop.AddDropHandler(Drop);
#endif
        }

        private static DragAndDropVisualMode Drop(
            Object dropUpon, Vector3 worldPosition, Vector2 viewportPosition, Transform parentForDraggedObjects,
            bool perform)
        {
            Object[] dragged = DragAndDrop.objectReferences;
            if (dragged.Length != 1 || !(dragged[0] is AvatarAsset asset))
            {
                return DragAndDropVisualMode.None;
            }
            if (perform)
            {
                Selection.activeObject = AvatarObject.Create(asset, parentForDraggedObjects, worldPosition);
            }
            return DragAndDropVisualMode.Copy;
        }
    }
}
