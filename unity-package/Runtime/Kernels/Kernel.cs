using System;
using UnityEngine;
using UnityEngine.Rendering;

namespace Mua
{
    /// <summary>One entry point of a compute shader, found by name; buffers and constants are set by property id.</summary>
    internal sealed class Kernel
    {
        private readonly ComputeShader shader;
        private readonly int index;

        /// <summary>InvalidOperationException says what is missing.</summary>
        public Kernel(ComputeShader shader, string file, string name)
        {
            if (shader == null)
            {
                throw new InvalidOperationException(
                    file + " is missing from AvatarResources; reimport the packages com.mua.kernels and com.mua.avatar.");
            }
            if (!shader.HasKernel(name))
            {
                throw new InvalidOperationException(
                    file + " has no kernel " + name + "; it did not compile, or com.mua.kernels is of another version.");
            }
            index = shader.FindKernel(name);
            if (!shader.IsSupported(index))
            {
                throw new InvalidOperationException(
                    SystemInfo.graphicsDeviceName + " cannot run the kernel " + name + " of " + file + ".");
            }
            this.shader = shader;
        }

        /// <summary>How many groups of `size` hold `count`.</summary>
        public static int Groups(int count, int size)
        {
            return (count + size - 1) / size;
        }

        public void Set(CommandBuffer commands, int name, GraphicsBuffer buffer)
        {
            commands.SetComputeBufferParam(shader, index, name, buffer);
        }

        public void Set(CommandBuffer commands, int name, int value)
        {
            commands.SetComputeIntParam(shader, name, value);
        }

        public void Set(CommandBuffer commands, int name, float value)
        {
            commands.SetComputeFloatParam(shader, name, value);
        }

        public void Set(CommandBuffer commands, int name, Vector4 value)
        {
            commands.SetComputeVectorParam(shader, name, value);
        }

        /// <summary>A uint3, which SetComputeIntParams fills without a gap.</summary>
        public void Set(CommandBuffer commands, int name, int[] values)
        {
            commands.SetComputeIntParams(shader, name, values);
        }

        /// <summary>A float2, which SetComputeVectorParam could overrun.</summary>
        public void Set(CommandBuffer commands, int name, float[] values)
        {
            commands.SetComputeFloatParams(shader, name, values);
        }

        public void Set(CommandBuffer commands, int name, Matrix4x4[] values)
        {
            commands.SetComputeMatrixArrayParam(shader, name, values);
        }

        /// <summary>A stored tensor: its words, and its layout as `stored()` of common.hlsl takes it.</summary>
        public void Set(CommandBuffer commands, int name, int layoutName, StoredBuffer stored)
        {
            Set(commands, name, stored.Words);
            Set(commands, layoutName, stored.Layout);
        }

        public void Dispatch(CommandBuffer commands, int x, int y, int z)
        {
            commands.DispatchCompute(shader, index, x, y, z);
        }
    }
}
