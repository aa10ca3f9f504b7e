// Writes what reaches the device as lines of JSON beside one binary (tests/unity/replay.py reads them). Not Unity's API.
using System;
using System.Collections.Generic;
using System.IO;
using System.Runtime.InteropServices;
using System.Text;
using UnityEngine;

namespace StandIns
{
    public enum Kinds { Int, Float, Vector, Matrix }

    public struct Value
    {
        public Kinds Kind;
        public byte[] Content;
    }

    /// <summary>Constants by name; set again without an allocation.</summary>
    public sealed class Bindings
    {
        internal readonly Dictionary<int, Value> Values = new Dictionary<int, Value>();

        internal void Set(int name, int value) { Bytes.Put(value, Place(name, Kinds.Int, 4), 0); }
        internal void Set(int name, float value) { Bytes.Put(value, Place(name, Kinds.Float, 4), 0); }
        internal void Set(int name, int[] values) { Bytes.Copy(values, 0, Place(name, Kinds.Int, 4 * values.Length), 0, 4 * values.Length); }
        internal void Set(int name, Vector4 value)
        {
            for (int i = 0; i < 4; i++)
                Bytes.Put(value[i], Place(name, Kinds.Vector, 16), 4 * i);
        }
        internal void Set(int name, Matrix4x4 value)
        {
            for (int i = 0; i < 16; i++)
                Bytes.Put(value[i], Place(name, Kinds.Matrix, 64), 4 * i);
        }
        internal void Set(int name, Matrix4x4[] values)
        {
            byte[] place = Place(name, Kinds.Matrix, 64 * values.Length);
            for (int i = 0; i < 16 * values.Length; i++)
                Bytes.Put(values[i / 16][i % 16], place, 4 * i);
        }
        internal void Set(int name, Vector4[] values)
        {
            byte[] place = Place(name, Kinds.Vector, 16 * values.Length);
            for (int i = 0; i < 4 * values.Length; i++)
                Bytes.Put(values[i / 4][i % 4], place, 4 * i);
        }
        internal void Set(int name, Value value, byte[] content, int start, int length)
        {
            Buffer.BlockCopy(content, start, Place(name, value.Kind, length), 0, length);
        }

        private byte[] Place(int name, Kinds kind, int length)
        {
            Value held;
            if (!Values.TryGetValue(name, out held) || held.Content.Length != length || held.Kind != kind)
                Values[name] = held = new Value { Kind = kind, Content = new byte[length] };
            return held.Content;
        }
    }

    public static class Bytes
    {
        [StructLayout(LayoutKind.Explicit)]
        private struct Word
        {
            [FieldOffset(0)] public int Int;
            [FieldOffset(0)] public float Float;
        }

        internal static void Put(float value, byte[] to, int start) { Put(new Word { Float = value }.Int, to, start); }
        internal static void Put(int value, byte[] to, int start)
        {
            for (int i = 0; i < 4; i++)
                to[start + i] = (byte)(value >> (8 * i));
        }

        /// <summary>Bytes of an array of any blittable elements.</summary>
        internal static void Copy(Array from, int start, byte[] to, int at, int length)
        {
            GCHandle pinned = GCHandle.Alloc(from, GCHandleType.Pinned);
            try
            {
                Marshal.Copy(new IntPtr(pinned.AddrOfPinnedObject().ToInt64() + start), to, at, length);
            }
            finally
            {
                pinned.Free();
            }
        }
    }

    public static class Recorder
    {
        private static readonly Dictionary<int, GraphicsBuffer> Alive = new Dictionary<int, GraphicsBuffer>();
        internal static readonly List<Material> Materials = new List<Material>();
        private static readonly Dictionary<int, string> Names = new Dictionary<int, string>();
        private static StreamWriter lines, paused;
        private static FileStream binary;

        public static int Made { get; private set; }
        public static int Dispatches { get; private set; }
        public static int Draws { get; private set; }
        public static int Renders { get; private set; }
        public static int Lookups { get; internal set; } // of ids by name

        /// <summary>What was last given to the lights.</summary>
        public static RenderParams LastRender { get; private set; }
        public static long UploadedBytes { get; private set; }
        public static bool IsOn { get { return lines != null; } }

        /// <summary>Buffers and materials that nobody has disposed and no change of scene takes away.</summary>
        public static int AliveCount { get { return Alive.Count + AliveMaterials().Count; } }

        /// <summary>Names of these.</summary>
        public static string AliveNames()
        {
            List<string> names = AliveMaterials().ConvertAll(material => material.name);
            foreach (int id in Alive.Keys)
                names.Add(Names.ContainsKey(id) ? Names[id] : "unnamed");
            return string.Join(", ", names.ToArray());
        }

        private static List<Material> AliveMaterials()
        {
            return Materials.FindAll(material => material != null && (material.hideFlags & HideFlags.DontSave) != 0);
        }

        /// <summary>Write from here on to `path`.json and `path`.bin, until Stop.</summary>
        public static void Start(string path)
        {
            lines = new StreamWriter(path + ".json");
            binary = new FileStream(path + ".bin", FileMode.Create);
        }

        /// <summary>Write nothing until Resume.</summary>
        public static void Pause()
        {
            paused = lines;
            lines = null;
        }

        public static void Resume() { lines = paused; }

        public static void Stop()
        {
            lines.Dispose();
            binary.Dispose();
            lines = null;
        }

        /// <summary>Let the replay keep what a buffer holds at this point.</summary>
        public static void Keep(GraphicsBuffer buffer, string label)
        {
            Line("{\"event\": \"keep\", \"buffer\": " + buffer.Id + ", \"label\": \"" + label + "\"}");
        }

        /// <summary>The shader of a .compute file; Unity's importer makes it.</summary>
        public static ComputeShader Compute(string path) { return new ComputeShader(path); }

        /// <summary>The shader of a .shader file of that name.</summary>
        public static Shader Drawing(string name) { return new Shader(name); }

        /// <summary>A line that says what goes on between others.</summary>
        public static void Note(string text)
        {
            if (lines != null)
                Line("{\"event\": \"note\", \"text\": \"" + text + "\"}");
        }

        internal static void Created(GraphicsBuffer buffer)
        {
            Made++;
            Alive[buffer.Id] = buffer;
            if (lines != null)
                Line("{\"event\": \"buffer\", \"buffer\": " + buffer.Id + ", \"count\": " + buffer.count + ", \"stride\": " + buffer.stride + ", \"target\": " + (int)buffer.target + "}");
        }

        internal static void Named(GraphicsBuffer buffer, string name)
        {
            Names[buffer.Id] = name;
            if (lines != null)
                Line("{\"event\": \"name\", \"buffer\": " + buffer.Id + ", \"name\": \"" + name + "\"}");
        }

        internal static void Released(GraphicsBuffer buffer)
        {
            Alive.Remove(buffer.Id);
            if (lines != null)
                Line("{\"event\": \"release\", \"buffer\": " + buffer.Id + "}");
        }

        internal static void Uploaded(GraphicsBuffer buffer, Array data, int from, int to, int bytes)
        {
            buffer.CheckUsable("SetData");
            UploadedBytes += bytes;
            if (lines == null)
                return;
            byte[] content = new byte[bytes];
            Bytes.Copy(data, from, content, 0, bytes);
            Line("{\"event\": \"upload\", \"buffer\": " + buffer.Id + ", \"start\": " + to + ", \"offset\": " + binary.Position + ", \"bytes\": " + bytes + "}");
            binary.Write(content, 0, bytes);
        }

        internal static void Copied(GraphicsBuffer source, GraphicsBuffer target)
        {
            source.CheckUsable("CopyBuffer");
            target.CheckUsable("CopyBuffer");
            if (lines != null)
                Line("{\"event\": \"copy\", \"source\": " + source.Id + ", \"buffer\": " + target.Id + "}");
        }

        internal static void Dispatched(ComputeShader shader, int kernel, int x, int y, int z, GraphicsBuffer arguments, int offset)
        {
            Dispatches++;
            foreach (KeyValuePair<int, GraphicsBuffer> bound in shader.Buffers[kernel])
                bound.Value.CheckUsable(shader.Kernels[kernel]);
            if (lines == null)
                return;
            string groups = arguments == null ? "\"groups\": [" + x + ", " + y + ", " + z + "]" : "\"indirect\": [" + arguments.Id + ", " + offset + "]";
            Line("{\"event\": \"dispatch\", \"shader\": \"" + shader.File + "\", \"kernel\": \"" + shader.Kernels[kernel] + "\", " + groups
                + ", \"buffers\": {" + Listed(shader.Buffers[kernel]) + "}, \"constants\": {" + Listed(shader.Constants) + "}}");
        }

        /// <summary>A draw that waits for the engine's own passes; one that only casts shadows is the shader's fourth.</summary>
        internal static void Rendered(RenderParams parameters, GraphicsBuffer indices, int count, int instances)
        {
            indices.CheckUsable("RenderPrimitivesIndexed");
            bool isShadow = parameters.shadowCastingMode == UnityEngine.Rendering.ShadowCastingMode.ShadowsOnly;
            Renders++;
            LastRender = parameters;
            WriteDraw(parameters.material, parameters.matProps, isShadow ? 3 : 0, count, instances, null, indices);
        }

        internal static void Drawn(Material material, MaterialPropertyBlock properties, int pass, int vertices, int instances, GraphicsBuffer arguments, GraphicsBuffer indices)
        {
            Draws++;
            CheckUsable(material.Buffers);
            if (properties != null)
                CheckUsable(properties.Buffers);
            if (arguments != null)
                arguments.CheckUsable("the arguments of a draw");
            if (indices != null)
                indices.CheckUsable("the indices of a draw");
            WriteDraw(material, properties, pass, vertices, instances, arguments, indices);
        }

        private static void CheckUsable(Dictionary<int, GraphicsBuffer> buffers)
        {
            foreach (KeyValuePair<int, GraphicsBuffer> bound in buffers)
                bound.Value.CheckUsable("a draw");
        }

        private static void WriteDraw(Material material, MaterialPropertyBlock properties, int pass, int vertices, int instances, GraphicsBuffer arguments, GraphicsBuffer indices)
        {
            if (lines == null)
                return;
            string counts = arguments == null ? "\"vertices\": " + vertices + ", \"instances\": " + instances : "\"indirect\": [" + arguments.Id + ", " + vertices + "]";
            counts += ", \"multiplier\": " + Graphics.InstanceMultiplier;
            if (indices != null)
                counts += ", \"indices\": " + indices.Id;
            string blocks = ", \"buffers\": {" + Listed(material.Buffers) + "}, \"constants\": {" + Listed(material.Constants) + "}";
            if (properties != null)
                blocks += ", \"block_buffers\": {" + Listed(properties.Buffers) + "}, \"block_constants\": {" + Listed(properties.Constants) + "}";
            Line("{\"event\": \"draw\", \"shader\": \"" + material.shader.name + "\", \"pass\": " + pass + ", " + counts + blocks + "}");
        }

        private static void Line(string text)
        {
            if (lines != null)
                lines.WriteLine(text);
        }

        private static string Listed(Dictionary<int, GraphicsBuffer> buffers)
        {
            List<string> parts = new List<string>();
            foreach (KeyValuePair<int, GraphicsBuffer> bound in buffers)
                parts.Add("\"" + Shader.NameOf(bound.Key) + "\": " + bound.Value.Id);
            return string.Join(", ", parts.ToArray());
        }

        private static string Listed(Bindings constants)
        {
            List<string> parts = new List<string>();
            foreach (KeyValuePair<int, Value> constant in constants.Values)
                parts.Add("\"" + Shader.NameOf(constant.Key) + "\": [\"" + constant.Value.Kind + "\", \"" + Convert.ToBase64String(constant.Value.Content) + "\"]");
            return string.Join(", ", parts.ToArray());
        }
    }
}
