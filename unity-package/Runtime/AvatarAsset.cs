using UnityEngine;

namespace Mua
{
    /// <summary>A `.muaavatar`: its bytes as they are, and, of an imported one, what the importer shows of it.</summary>
    public sealed class AvatarAsset : ScriptableObject
    {
        [SerializeField, HideInInspector] private byte[] content = new byte[0];
        [SerializeField] private Texture2D thumbnail = null;
        [SerializeField, HideInInspector] private string summary = "";
        [SerializeField, HideInInspector] private string fault = "";
        [SerializeField, HideInInspector] private bool isTemporary = false;

        /// <summary>The bytes of the file, which must not be changed.</summary>
        public byte[] Content => content;

        /// <summary>The picture that the file brings; null where it brings none.</summary>
        public Texture2D Thumbnail => thumbnail;

        /// <summary>What the file holds: a line for each row of a table, cells apart by tabs, tables by empty lines.</summary>
        public string Summary => summary;

        /// <summary>Why the avatar cannot be shown: one sentence; empty where it can.</summary>
        public string Fault => fault;

        /// <summary>Whether the components that show it made it and destroy it.</summary>
        internal bool IsTemporary => isTemporary;

        /// <summary>An asset of a file's bytes, which it keeps.</summary>
        public static AvatarAsset Create(byte[] content, Texture2D thumbnail = null, string summary = "")
        {
            var asset = CreateInstance<AvatarAsset>();
            asset.content = content;
            asset.thumbnail = thumbnail;
            asset.summary = summary;
            return asset;
        }

        /// <summary>An asset of a file's bytes for the components that show it; no scene saves it.</summary>
        internal static AvatarAsset CreateTemporary(byte[] content, string name)
        {
            AvatarAsset asset = Create(content);
            asset.name = name;
            asset.isTemporary = true;
            asset.hideFlags = HideFlags.DontSaveInEditor | HideFlags.DontSaveInBuild;
            return asset;
        }

        /// <summary>An asset in place of a file that cannot be shown.</summary>
        public static AvatarAsset CreateFaulty(string fault)
        {
            var asset = CreateInstance<AvatarAsset>();
            asset.fault = fault;
            return asset;
        }
    }
}
