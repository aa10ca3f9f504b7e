using UnityEngine;

namespace Mua
{
    /// <summary>An imported `.muaavatar`: its bytes as they are, and what the importer shows of it.</summary>
    public sealed class AvatarAsset : ScriptableObject
    {
        [SerializeField, HideInInspector] private byte[] content = new byte[0];
        [SerializeField] private Texture2D thumbnail = null;
        [SerializeField, HideInInspector] private string summary = "";
        [SerializeField, HideInInspector] private string fault = "";

        /// <summary>The bytes of the file, which must not be changed.</summary>
        public byte[] Content => content;

        /// <summary>The picture that the file brings; null where it brings none.</summary>
        public Texture2D Thumbnail => thumbnail;

        /// <summary>What the file holds: a line for each row of a table, cells apart by tabs, tables by empty lines.</summary>
        public string Summary => summary;

        /// <summary>Why the avatar cannot be shown: one sentence; empty where it can.</summary>
        public string Fault => fault;

        /// <summary>An asset of a file's bytes, which it keeps.</summary>
        public static AvatarAsset Create(byte[] content, Texture2D thumbnail = null, string summary = "")
        {
            var asset = CreateInstance<AvatarAsset>();
            asset.content = content;
            asset.thumbnail = thumbnail;
            asset.summary = summary;
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
