// Stand-in. Source: Unity's Graphics repository, com.unity.render-pipelines.core 17.0, Runtime/CommandBuffers: each wraps
// the CommandBuffer of the graph's execution.
namespace UnityEngine.Rendering
{
    public class BaseCommandBuffer
    {
        internal CommandBuffer Wrapped;
    }

    public class RasterCommandBuffer : BaseCommandBuffer
    {
        public void BeginSample(Unity.Profiling.ProfilerMarker marker) { Wrapped.BeginSample(marker); }
        public void EndSample(Unity.Profiling.ProfilerMarker marker) { Wrapped.EndSample(marker); }
        public void DrawProcedural(Matrix4x4 matrix, Material material, int shaderPass, MeshTopology topology, int vertexCount, int instanceCount, MaterialPropertyBlock properties)
        {
            Wrapped.DrawProcedural(matrix, material, shaderPass, topology, vertexCount, instanceCount, properties);
        }
        public void DrawProcedural(GraphicsBuffer indexBuffer, Matrix4x4 matrix, Material material, int shaderPass, MeshTopology topology, int indexCount, int instanceCount, MaterialPropertyBlock properties)
        {
            Wrapped.DrawProcedural(indexBuffer, matrix, material, shaderPass, topology, indexCount, instanceCount, properties);
        }
        public void DrawProceduralIndirect(Matrix4x4 matrix, Material material, int shaderPass, MeshTopology topology, GraphicsBuffer bufferWithArgs, int argsOffset, MaterialPropertyBlock properties)
        {
            Wrapped.DrawProceduralIndirect(matrix, material, shaderPass, topology, bufferWithArgs, argsOffset, properties);
        }
    }

    public class UnsafeCommandBuffer : BaseCommandBuffer { }

    public struct CommandBufferHelpers
    {
        public static CommandBuffer GetNativeCommandBuffer(UnsafeCommandBuffer baseBuffer) { return baseBuffer.Wrapped; }
    }

    public class ProfilingSampler
    {
        public ProfilingSampler(string name) { this.name = name; }
        public string name { get; private set; }
    }
}
