using UnityEngine;

namespace Mua.Samples.VrPlayer
{
    /// <summary>Draws a TextMesh by a shader that tests depth, with the font's own texture.</summary>
    [DisallowMultipleComponent, RequireComponent(typeof(TextMesh))]
    internal sealed class StandingText : MonoBehaviour
    {
        [SerializeField] private Shader shader = null;

        private Font font;
        private Material material;

        internal void Connect(Shader shader)
        {
            this.shader = shader;
        }

        private void Start()
        {
            font = GetComponent<TextMesh>().font;
            material = new Material(shader) { hideFlags = HideFlags.DontSave };
            GetComponent<MeshRenderer>().sharedMaterial = material;
            Font.textureRebuilt += TakeTexture;
            TakeTexture(font);
        }

        private void OnDestroy()
        {
            Font.textureRebuilt -= TakeTexture;
            Destroy(material);
        }

        private void TakeTexture(Font rebuilt)
        {
            material.mainTexture = font.material.mainTexture;
        }
    }
}
