using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using UnityEngine;
using UnityEngine.Rendering;

namespace Mua.SelfTest
{
    /// <summary>One golden case on the device: its buffers, its dispatch, and its result.</summary>
    internal sealed class CaseRun
    {
        private readonly GoldenFile file;
        private readonly GoldenCase golden;
        private readonly Dictionary<string, GraphicsBuffer> buffers = new Dictionary<string, GraphicsBuffer>();

        private CaseRun(GoldenFile file, GoldenCase golden)
        {
            this.file = file;
            this.golden = golden;
        }

        /// <summary>
        /// Runs a case and waits for it; the first buffer that is not as it must be, and where, or nothing where all are.
        /// InvalidOperationException or ArgumentException says what the device or the package lacks.
        /// </summary>
        public static string Difference(ComputeShader shader, GoldenFile file, GoldenCase golden)
        {
            var kernel = new Kernel(shader, file.kernel, golden.entry);
            using (var held = new BufferSet())
            {
                var run = new CaseRun(file, golden);
                run.Upload(held);
                run.Dispatch(kernel);
                return run.Compare();
            }
        }

        private void Upload(BufferSet held)
        {
            foreach (GoldenBuffer described in golden.buffers)
            {
                var words = new uint[described.count * described.Words];
                Buffer.BlockCopy(file.Binary, described.offset, words, 0, sizeof(uint) * words.Length);
                string name = "golden " + described.name;
                GraphicsBuffer buffer = held.Structured(name, described.count, sizeof(uint) * described.Words);
                buffer.SetData(words);
                buffers[described.name] = buffer;
            }
        }

        private void Dispatch(Kernel kernel)
        {
            using (var commands = new CommandBuffer { name = "MUA self-test" })
            {
                foreach (KeyValuePair<string, GraphicsBuffer> buffer in buffers)
                {
                    kernel.Set(commands, Shader.PropertyToID(buffer.Key), buffer.Value);
                }
                foreach (GoldenConstant constant in golden.constants)
                {
                    Set(kernel, commands, constant);
                }
                kernel.Dispatch(commands, golden.groups[0], golden.groups[1], golden.groups[2]);
                Graphics.ExecuteCommandBuffer(commands);
            }
        }

        private string Compare()
        {
            var read = new Dictionary<string, uint[]>();
            foreach (GoldenExpected part in golden.expected)
            {
                if (!read.ContainsKey(part.buffer))
                {
                    read[part.buffer] = Read(part.buffer);
                }
            }
            IEnumerable<string> differences = golden.expected.Select(part => Compare(part, read[part.buffer]));
            return differences.FirstOrDefault(difference => difference.Length > 0) ?? "";
        }

        private uint[] Read(string name)
        {
            GraphicsBuffer buffer = buffers[name];
            var words = new uint[buffer.count * (buffer.stride / sizeof(uint))];
            try
            {
                buffer.GetData(words);
            }
            catch (Exception error) // whatever the engine refuses, the case fails and the run goes on
            {
                throw new InvalidOperationException(name + " could not be read back: " + error.Message);
            }
            return words;
        }

        private static void Set(Kernel kernel, CommandBuffer commands, GoldenConstant constant)
        {
            int id = Shader.PropertyToID(constant.name);
            double[] values = constant.values;
            if (constant.shape.Length == 3)
            {
                kernel.Set(commands, id, Matrices(values));
            }
            else if (constant.scalar == "uint")
            {
                int[] words = Array.ConvertAll(values, value => unchecked((int)(uint)value));
                if (constant.shape.Length == 0)
                {
                    kernel.Set(commands, id, words[0]);
                }
                else
                {
                    kernel.Set(commands, id, words);
                }
            }
            else if (constant.shape.Length == 0)
            {
                kernel.Set(commands, id, (float)values[0]);
            }
            else if (values.Length == 4)
            {
                var vector = new Vector4((float)values[0], (float)values[1], (float)values[2], (float)values[3]);
                kernel.Set(commands, id, vector);
            }
            else
            {
                kernel.Set(commands, id, Array.ConvertAll(values, value => (float)value));
            }
        }

        /// <summary>Matrices from values in row-major order.</summary>
        private static Matrix4x4[] Matrices(double[] values)
        {
            var matrices = new Matrix4x4[values.Length / 16];
            for (int i = 0; i < values.Length; i++)
            {
                matrices[i / 16][i % 16 / 4, i % 4] = (float)values[i];
            }
            return matrices;
        }

        private string Compare(GoldenExpected part, uint[] words)
        {
            int wrong = 0, first = 0;
            for (int i = 0; i < part.count; i++)
            {
                if (!part.Allows(part.Found(words, i), part.Wanted(file.Binary, i)))
                {
                    first = wrong == 0 ? i : first;
                    wrong++;
                }
            }
            if (wrong == 0)
            {
                return "";
            }
            double wanted = part.Wanted(file.Binary, first);
            return string.Format(
                CultureInfo.InvariantCulture,
                "{0}: word {1} has {2:G9} as {3}, wanted {4:G9} within {5:G3}; {6} of {7} values are wrong",
                part.buffer, part.Word(first), part.Found(words, first), part.kind, wanted,
                part.absolute + part.relative * Math.Abs(wanted), wrong, part.count);
        }
    }
}
