// Stand-in. Source: Unity 6000.0 scripting reference, Shader, Material, MaterialPropertyBlock.
using System;
using System.Collections.Generic;

namespace UnityEngine
{
    public sealed class Shader : Object
    {
        private static readonly Dictionary<string, int> Ids = new Dictionary<string, int>();
        private static readonly List<string> Names = new List<string>();

        internal Shader(string name) { this.name = name; }

        public bool isSupported { get { return true; } }
        public static Shader Find(string name) { return new Shader(name); }
        public static int PropertyToID(string name)
        {
            int id;
            StandIns.Recorder.Lookups++;
            if (Ids.TryGetValue(name, out id))
                return id;
            Names.Add(name);
            return Ids[name] = Names.Count - 1;
        }

        internal static string NameOf(int id) { return Names[id]; }
    }

    public class Material : Object
    {
        internal readonly StandIns.Bindings Constants = new StandIns.Bindings();
        internal readonly Dictionary<int, GraphicsBuffer> Buffers = new Dictionary<int, GraphicsBuffer>();

        public Material(Shader shader)
        {
            if (shader == null)
                throw new ArgumentNullException("shader");
            this.shader = shader;
            name = shader.name;
            StandIns.Recorder.Materials.Add(this);
        }

        public Shader shader { get; set; }
        public Color color { get; set; }
        public Texture mainTexture { get; set; }
        public void SetInt(int nameID, int value) { Constants.Set(nameID, value); }
        public void SetInteger(int nameID, int value) { Constants.Set(nameID, value); }
        public void SetFloat(int nameID, float value) { Constants.Set(nameID, value); }
        public void SetVector(int nameID, Vector4 value) { Constants.Set(nameID, value); }
        public void SetMatrixArray(int nameID, Matrix4x4[] values) { Constants.Set(nameID, values); }
        public void SetVectorArray(int nameID, Vector4[] values) { Constants.Set(nameID, values); }
        public void SetBuffer(int nameID, GraphicsBuffer value) { Buffers[nameID] = value; }
    }

    public sealed class MaterialPropertyBlock
    {
        internal readonly StandIns.Bindings Constants = new StandIns.Bindings();
        internal readonly Dictionary<int, GraphicsBuffer> Buffers = new Dictionary<int, GraphicsBuffer>();

        public void Clear() { Buffers.Clear(); }
        public void SetInt(int nameID, int value) { Constants.Set(nameID, value); }
        public void SetInteger(int nameID, int value) { Constants.Set(nameID, value); }
        public void SetFloat(int nameID, float value) { Constants.Set(nameID, value); }
        public void SetVector(int nameID, Vector4 value) { Constants.Set(nameID, value); }
        public void SetMatrixArray(int nameID, Matrix4x4[] values) { Constants.Set(nameID, values); }
        public void SetVectorArray(int nameID, Vector4[] values) { Constants.Set(nameID, values); }
        public void SetBuffer(int nameID, GraphicsBuffer value) { Buffers[nameID] = value; }
    }
}
