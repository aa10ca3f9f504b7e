using System;
using System.Collections.Generic;
using System.Globalization;
using UnityEngine;
using UnityEngine.Rendering;

namespace Mua.SelfTest
{
    /// <summary>One golden case on the device: its buffers, its dispatch, and what came of it.</summary>
    internal sealed class CaseRun : IDisposable
    {
        private readonly GoldenFile file;
        private readonly GoldenCase golden;
        private readonly GraphicsBuffer[] buffers;
        private readonly Dictionary<string, Readback> readbacks = new Dictionary<string, Readback>();

        /// <summary>
        /// Dispatches; `waits` as of Readback. InvalidOperationException or ArgumentException says what the device or
        /// the package lacks.
        /// </summary>
        public CaseRun(ComputeShader shader, GoldenFile file, GoldenCase golden, bool waits)
        {
            this.file = file;
            this.golden = golden;
            buffers = new GraphicsBuffer[golden.buffers.Length];
            try
            {
                Dispatch(new Kernel(shader, file.kernel, golden.entry));
                foreach (GoldenExpected part in golden.expected)
                {
                    if (!readbacks.ContainsKey(part.buffer))
                    {
                        readbacks[part.buffer] = new Readback(buffers[golden.IndexOf(part.buffer)], waits);
                    }
                }
            }
            catch
            {
                Dispose();
                throw;
            }
        }

        /// <summary>Whether Difference can be asked.</summary>
        public bool Continue()
        {
            bool isDone = true;
            foreach (Readback readback in readbacks.Values)
            {
                isDone &= readback.Continue();
            }
            return isDone;
        }

        /// <summary>The first buffer that is not as it must be, and where; empty where all are.</summary>
        public string Difference()
        {
            foreach (GoldenExpected part in golden.expected)
            {
                Readback readback = readbacks[part.buffer];
                bool isRead = readback.Problem.Length == 0;
                string found = isRead ? Compare(part, readback.Words) : part.buffer + " " + readback.Problem;
                if (found.Length > 0)
                {
                    return found;
                }
            }
            return "";
        }

        public void Dispose()
        {
            for (int i = 0; i < buffers.Length; i++)
            {
                if (buffers[i] != null)
                {
                    buffers[i].Dispose();
                    buffers[i] = null;
                }
            }
        }

        private void Dispatch(Kernel kernel)
        {
            using (var commands = new CommandBuffer { name = "MUA self-test" })
            {
                for (int i = 0; i < buffers.Length; i++)
                {
                    GoldenBuffer described = golden.buffers[i];
                    buffers[i] = Upload(described);
                    kernel.Set(commands, Shader.PropertyToID(described.name), buffers[i]);
                }
                foreach (GoldenConstant constant in golden.constants)
                {
                    Set(kernel, commands, constant);
                }
                kernel.Dispatch(commands, golden.groups[0], golden.groups[1], golden.groups[2]);
                Graphics.ExecuteCommandBuffer(commands);
            }
        }

        private GraphicsBuffer Upload(GoldenBuffer described)
        {
            var words = new uint[described.count * described.Words];
            Buffer.BlockCopy(file.Binary, described.offset, words, 0, sizeof(uint) * words.Length);
            var buffer = new GraphicsBuffer(
                GraphicsBuffer.Target.Structured, described.count, sizeof(uint) * described.Words);
            buffer.name = "MUA golden " + described.name;
            buffer.SetData(words);
            return buffer;
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

        /// <summary>Of values row by row.</summary>
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
