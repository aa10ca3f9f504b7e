// Stand-in. Source: Unity 6000.0, CommandBuffer: its commands run when it is executed.
using System;
using System.Runtime.InteropServices;

namespace UnityEngine
{
    public enum MeshTopology { Triangles, Quads = 2, Lines, LineStrip, Points }

    public static class Graphics
    {
        internal static uint InstanceMultiplier = 1;

        public static void ExecuteCommandBuffer(Rendering.CommandBuffer buffer) { buffer.Run(); }
        public static void RenderPrimitivesIndexed(in RenderParams rparams, MeshTopology topology, GraphicsBuffer indexBuffer, int indexCount, int startIndex = 0, int instanceCount = 1)
        {
            StandIns.Recorder.Rendered(rparams, indexBuffer, indexCount, instanceCount);
        }
    }
}

namespace UnityEngine.Rendering
{
    public sealed class CommandBuffer : IDisposable
    {
        private enum Kind { Constant, Buffer, Upload, Copy, Dispatch, Draw, Multiplier, Note }

        private struct Command
        {
            public Kind Kind;
            public ComputeShader Shader;
            public int Kernel, Name, X, Y, Z, Start;
            public StandIns.Value Value;
            public GraphicsBuffer Buffer, Indices, Source;
            public string Text;
            public Material Material;
            public MaterialPropertyBlock Properties;
        }

        private Command[] commands = new Command[64];
        private byte[] payload = new byte[1024];
        private readonly string[] open = new string[8]; // samples, each within the one before
        private int count, used, depth;

        public string name { get; set; }

        public void Dispose() { Clear(); }
        public void Release() { Dispose(); }
        public void Clear() { count = used = 0; }
        public void BeginSample(string name) { open[depth++] = name; }
        public void EndSample(string name)
        {
            if (depth == 0 || open[--depth] != name)
                throw new InvalidOperationException("the sample " + name + " ends, but did not begin last");
        }
        public void BeginSample(Unity.Profiling.ProfilerMarker marker) { BeginSample(marker.Name); }
        public void EndSample(Unity.Profiling.ProfilerMarker marker) { EndSample(marker.Name); }
        public void SetInstanceMultiplier(uint multiplier) { Append(new Command { Kind = Kind.Multiplier, X = (int)multiplier }); }

        public void SetComputeIntParam(ComputeShader computeShader, int nameID, int val)
        {
            Constant(computeShader, nameID, StandIns.Kinds.Int, Reserve(4));
            StandIns.Bytes.Put(val, payload, used - 4);
        }
        public void SetComputeFloatParam(ComputeShader computeShader, int nameID, float val)
        {
            Constant(computeShader, nameID, StandIns.Kinds.Float, Reserve(4));
            StandIns.Bytes.Put(val, payload, used - 4);
        }
        public void SetComputeVectorParam(ComputeShader computeShader, int nameID, Vector4 val)
        {
            Constant(computeShader, nameID, StandIns.Kinds.Vector, Reserve(16));
            for (int i = 0; i < 4; i++)
                StandIns.Bytes.Put(val[i], payload, used - 16 + 4 * i);
        }
        public void SetComputeIntParams(ComputeShader computeShader, int nameID, params int[] values)
        {
            Constant(computeShader, nameID, StandIns.Kinds.Int, Reserve(4 * values.Length));
            Buffer.BlockCopy(values, 0, payload, used - 4 * values.Length, 4 * values.Length);
        }
        public void SetComputeFloatParams(ComputeShader computeShader, int nameID, params float[] values)
        {
            Constant(computeShader, nameID, StandIns.Kinds.Float, Reserve(4 * values.Length));
            Buffer.BlockCopy(values, 0, payload, used - 4 * values.Length, 4 * values.Length);
        }
        public void SetComputeMatrixArrayParam(ComputeShader computeShader, int nameID, Matrix4x4[] values)
        {
            Constant(computeShader, nameID, StandIns.Kinds.Matrix, Reserve(64 * values.Length));
            for (int i = 0; i < 16 * values.Length; i++)
                StandIns.Bytes.Put(values[i / 16][i % 16], payload, used - 64 * values.Length + 4 * i);
        }
        public void SetComputeBufferParam(ComputeShader computeShader, int kernelIndex, int nameID, GraphicsBuffer buffer)
        {
            if (buffer == null)
                throw new ArgumentNullException("buffer");
            Append(new Command { Kind = Kind.Buffer, Shader = computeShader, Kernel = kernelIndex, Name = nameID, Buffer = buffer });
        }
        public void DispatchCompute(ComputeShader computeShader, int kernelIndex, int threadGroupsX, int threadGroupsY, int threadGroupsZ)
        {
            computeShader.CheckGroups(kernelIndex, threadGroupsX, threadGroupsY, threadGroupsZ);
            Append(new Command { Kind = Kind.Dispatch, Shader = computeShader, Kernel = kernelIndex, X = threadGroupsX, Y = threadGroupsY, Z = threadGroupsZ });
        }
        public void DispatchCompute(ComputeShader computeShader, int kernelIndex, GraphicsBuffer indirectBuffer, uint argsOffset)
        {
            if ((indirectBuffer.target & GraphicsBuffer.Target.IndirectArguments) == 0)
                throw new ArgumentException("indirectBuffer must have been created with the IndirectArguments target");
            if (argsOffset % 4 != 0 || argsOffset + 12 > (long)indirectBuffer.count * indirectBuffer.stride)
                throw new ArgumentException("argsOffset " + argsOffset);
            Append(new Command { Kind = Kind.Dispatch, Shader = computeShader, Kernel = kernelIndex, Buffer = indirectBuffer, X = (int)argsOffset });
        }
        public void SetBufferData(GraphicsBuffer buffer, Array data) { SetBufferData(buffer, data, 0, 0, GraphicsBuffer.Length(data)); }
        public void SetBufferData(GraphicsBuffer buffer, Array data, int managedBufferStartIndex, int graphicsBufferStartIndex, int count)
        {
            int element = buffer.Checked(data, managedBufferStartIndex, graphicsBufferStartIndex, count), bytes = count * element;
            int start = Reserve(bytes);
            StandIns.Bytes.Copy(data, managedBufferStartIndex * element, payload, start, bytes);
            Append(new Command { Kind = Kind.Upload, Buffer = buffer, X = graphicsBufferStartIndex * element, Y = bytes, Start = start });
        }
        public void CopyBuffer(GraphicsBuffer source, GraphicsBuffer dest)
        {
            if ((source.target & GraphicsBuffer.Target.CopySource) == 0)
                throw new ArgumentException("source must have been created with the CopySource target");
            if ((dest.target & GraphicsBuffer.Target.CopyDestination) == 0)
                throw new ArgumentException("dest must have been created with the CopyDestination target");
            if ((long)source.count * source.stride != (long)dest.count * dest.stride)
                throw new ArgumentException("source and dest must be of one size");
            Append(new Command { Kind = Kind.Copy, Source = source, Buffer = dest });
        }
        public void DrawProcedural(Matrix4x4 matrix, Material material, int shaderPass, MeshTopology topology, int vertexCount)
        {
            DrawProcedural(matrix, material, shaderPass, topology, vertexCount, 1, null);
        }
        public void DrawProcedural(Matrix4x4 matrix, Material material, int shaderPass, MeshTopology topology, int vertexCount, int instanceCount)
        {
            DrawProcedural(matrix, material, shaderPass, topology, vertexCount, instanceCount, null);
        }
        public void DrawProcedural(Matrix4x4 matrix, Material material, int shaderPass, MeshTopology topology, int vertexCount, int instanceCount, MaterialPropertyBlock properties)
        {
            Append(new Command { Kind = Kind.Draw, Material = material, Properties = properties, Kernel = shaderPass, X = vertexCount, Y = instanceCount });
        }
        public void DrawProcedural(GraphicsBuffer indexBuffer, Matrix4x4 matrix, Material material, int shaderPass, MeshTopology topology, int indexCount, int instanceCount, MaterialPropertyBlock properties)
        {
            CheckIndices(indexBuffer);
            Append(new Command { Kind = Kind.Draw, Material = material, Properties = properties, Kernel = shaderPass, Indices = indexBuffer, X = indexCount, Y = instanceCount });
        }
        public void DrawProceduralIndirect(Matrix4x4 matrix, Material material, int shaderPass, MeshTopology topology, GraphicsBuffer bufferWithArgs)
        {
            DrawProceduralIndirect(matrix, material, shaderPass, topology, bufferWithArgs, 0, null);
        }
        public void DrawProceduralIndirect(Matrix4x4 matrix, Material material, int shaderPass, MeshTopology topology, GraphicsBuffer bufferWithArgs, int argsOffset)
        {
            DrawProceduralIndirect(matrix, material, shaderPass, topology, bufferWithArgs, argsOffset, null);
        }
        public void DrawProceduralIndirect(Matrix4x4 matrix, Material material, int shaderPass, MeshTopology topology, GraphicsBuffer bufferWithArgs, int argsOffset, MaterialPropertyBlock properties)
        {
            DrawIndirect(null, material, shaderPass, bufferWithArgs, argsOffset, properties);
        }
        public void DrawProceduralIndirect(GraphicsBuffer indexBuffer, Matrix4x4 matrix, Material material, int shaderPass, MeshTopology topology, GraphicsBuffer bufferWithArgs, int argsOffset, MaterialPropertyBlock properties)
        {
            CheckIndices(indexBuffer);
            DrawIndirect(indexBuffer, material, shaderPass, bufferWithArgs, argsOffset, properties);
        }

        /// <summary>Not Unity's: a line of the recording when it is executed.</summary>
        internal void Note(string text) { Append(new Command { Kind = Kind.Note, Text = text }); }

        internal void Run()
        {
            if (depth > 0)
                throw new InvalidOperationException("the sample " + open[depth - 1] + " does not end");
            for (int i = 0; i < count; i++)
                Run(ref commands[i]);
        }

        private void Run(ref Command command)
        {
            switch (command.Kind)
            {
                case Kind.Constant: command.Shader.Constants.Set(command.Name, command.Value, payload, command.Start, command.Y); break;
                case Kind.Buffer: command.Shader.Bind(command.Kernel, command.Name, command.Buffer); break;
                case Kind.Upload: StandIns.Recorder.Uploaded(command.Buffer, payload, command.Start, command.X, command.Y); break;
                case Kind.Multiplier: Graphics.InstanceMultiplier = (uint)command.X; break;
                case Kind.Note: StandIns.Recorder.Note(command.Text); break;
                case Kind.Copy: StandIns.Recorder.Copied(command.Source, command.Buffer); break;
                case Kind.Draw: StandIns.Recorder.Drawn(command.Material, command.Properties, command.Kernel, command.X, command.Y, command.Buffer, command.Indices); break;
                default: StandIns.Recorder.Dispatched(command.Shader, command.Kernel, command.X, command.Y, command.Z, command.Buffer, command.X); break;
            }
        }

        private void DrawIndirect(GraphicsBuffer indices, Material material, int shaderPass, GraphicsBuffer bufferWithArgs, int argsOffset, MaterialPropertyBlock properties)
        {
            if ((bufferWithArgs.target & GraphicsBuffer.Target.IndirectArguments) == 0)
                throw new ArgumentException("bufferWithArgs must have been created with the IndirectArguments target");
            Append(new Command { Kind = Kind.Draw, Material = material, Properties = properties, Kernel = shaderPass, Indices = indices, Buffer = bufferWithArgs, X = argsOffset });
        }

        private static void CheckIndices(GraphicsBuffer indexBuffer)
        {
            if ((indexBuffer.target & GraphicsBuffer.Target.Index) == 0)
                throw new ArgumentException("indexBuffer must have been created with the Index target");
        }

        private void Constant(ComputeShader shader, int name, StandIns.Kinds kind, int start)
        {
            Append(new Command { Kind = Kind.Constant, Shader = shader, Name = name, Value = new StandIns.Value { Kind = kind }, Start = start, Y = used - start });
        }

        private void Append(Command command)
        {
            if (count == commands.Length)
                Array.Resize(ref commands, 2 * count);
            commands[count++] = command;
        }

        private int Reserve(int bytes)
        {
            if (used + bytes > payload.Length)
                Array.Resize(ref payload, 2 * (used + bytes));
            used += bytes;
            return used - bytes;
        }
    }
}

namespace Unity.Profiling
{
    public struct ProfilerMarker
    {
        public struct AutoScope : IDisposable { public void Dispose() { } }

        internal readonly string Name;

        public ProfilerMarker(string name) { Name = name; }
        public ProfilerMarker(ProfilerCategory category, string name, LowLevel.MarkerFlags flags) { Name = name; }
        public void Begin() { }
        public void End() { }
        public AutoScope Auto() { return new AutoScope(); }
    }
}
