// Stand-in. Source: Unity 6000.0, ComputeShader. Kernels and group sizes are read from the .compute file.
using System;
using System.Collections.Generic;
using System.IO;
using System.Text.RegularExpressions;

namespace UnityEngine
{
    public sealed class ComputeShader : Object
    {
        private static readonly Regex Kernel = new Regex(@"^\s*#\s*pragma\s+kernel\s+(\w+)", RegexOptions.Multiline);
        private static readonly Regex Threads = new Regex(@"\[numthreads\((\w+),\s*(\w+),\s*(\w+)\)\]\s*void\s+(\w+)\s*\(");
        private static readonly Regex Define = new Regex(@"^\s*(?:#\s*define\s+(\w+)[ \t]+|static const uint (\w+) = )(\w+)", RegexOptions.Multiline);
        private static readonly Regex Include = new Regex("^\\s*#\\s*include\\s+\"([^\"]+)\"", RegexOptions.Multiline);

        internal readonly string File;
        internal readonly List<string> Kernels = new List<string>();
        internal readonly StandIns.Bindings Constants = new StandIns.Bindings();
        internal readonly List<Dictionary<int, GraphicsBuffer>> Buffers = new List<Dictionary<int, GraphicsBuffer>>();
        private readonly Dictionary<string, uint[]> sizes = new Dictionary<string, uint[]>();

        internal ComputeShader(string path)
        {
            File = Path.GetFileName(path);
            name = Path.GetFileNameWithoutExtension(path);
            string text = System.IO.File.ReadAllText(path);
            foreach (Match match in Kernel.Matches(text))
            {
                Kernels.Add(match.Groups[1].Value);
                Buffers.Add(new Dictionary<int, GraphicsBuffer>());
            }
            Dictionary<string, string> defines = new Dictionary<string, string>();
            ReadDefines(path, text, defines);
            foreach (Match match in Threads.Matches(text))
                sizes[match.Groups[4].Value] = new[] { Size(match, 1, defines), Size(match, 2, defines), Size(match, 3, defines) };
        }

        public int FindKernel(string name)
        {
            int found = Kernels.IndexOf(name);
            if (found < 0)
                throw new ArgumentException("Kernel '" + name + "' not found.");
            return found;
        }
        public bool HasKernel(string name) { return Kernels.Contains(name); }
        public bool IsSupported(int kernelIndex) { return SystemInfo.supportsComputeShaders; }
        public void SetInt(int nameID, int val) { Constants.Set(nameID, val); }
        public void SetFloat(int nameID, float val) { Constants.Set(nameID, val); }
        public void SetVector(int nameID, Vector4 val) { Constants.Set(nameID, val); }
        public void SetMatrixArray(int nameID, Matrix4x4[] values) { Constants.Set(nameID, values); }
        public void SetBuffer(int kernelIndex, int nameID, GraphicsBuffer buffer) { Bind(kernelIndex, nameID, buffer); }
        public void SetBuffer(int kernelIndex, string name, GraphicsBuffer buffer) { Bind(kernelIndex, Shader.PropertyToID(name), buffer); }
        public void SetInt(string name, int val) { Constants.Set(Shader.PropertyToID(name), val); }
        public void SetFloat(string name, float val) { Constants.Set(Shader.PropertyToID(name), val); }
        public void Dispatch(int kernelIndex, int threadGroupsX, int threadGroupsY, int threadGroupsZ)
        {
            CheckGroups(kernelIndex, threadGroupsX, threadGroupsY, threadGroupsZ);
            StandIns.Recorder.Dispatched(this, kernelIndex, threadGroupsX, threadGroupsY, threadGroupsZ, null, 0);
        }

        internal void Bind(int kernel, int id, GraphicsBuffer buffer)
        {
            if (buffer == null)
                throw new ArgumentNullException("buffer");
            buffer.CheckUsable(Shader.NameOf(id));
            if ((buffer.target & GraphicsBuffer.Target.Structured) == 0)
                throw new ArgumentException(Shader.NameOf(id) + " of " + Kernels[kernel] + " is a structured buffer; the target given is " + buffer.target);
            Buffers[kernel][id] = buffer;
        }

        internal void CheckGroups(int kernel, int x, int y, int z)
        {
            if (x <= 0 || y <= 0 || z <= 0 || x > 65535 || y > 65535 || z > 65535)
                throw new ArgumentException("Thread group count must be above zero and at most 65535: " + Kernels[kernel] + " " + x + " " + y + " " + z);
        }

        private static void ReadDefines(string path, string text, Dictionary<string, string> defines)
        {
            foreach (Match match in Include.Matches(text))
            {
                string included = Path.Combine(Path.GetDirectoryName(path), match.Groups[1].Value);
                ReadDefines(included, System.IO.File.ReadAllText(included), defines);
            }
            foreach (Match match in Define.Matches(text))
                defines[match.Groups[1].Value + match.Groups[2].Value] = match.Groups[3].Value;
        }

        private static uint Size(Match match, int group, Dictionary<string, string> defines)
        {
            string word = match.Groups[group].Value;
            while (defines.ContainsKey(word))
                word = defines[word];
            return uint.Parse(word);
        }
    }
}
