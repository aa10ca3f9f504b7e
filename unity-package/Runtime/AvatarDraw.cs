using UnityEngine;
using UnityEngine.Rendering;

namespace Mua
{
    /// <summary>One procedural draw of triangles, for whichever pipeline's command buffer.</summary>
    internal readonly struct AvatarDraw
    {
        public Material Material { get; }

        /// <summary>Index of the material's pass.</summary>
        public int Pass { get; }

        public MaterialPropertyBlock Properties { get; }

        /// <summary>Null where the draw is not indexed.</summary>
        public GraphicsBuffer Indices { get; }

        /// <summary>Arguments of an indirect draw, from byte 0; null for a direct draw of Count and Instances.</summary>
        public GraphicsBuffer Arguments { get; }

        /// <summary>Vertices, or indices where there are any.</summary>
        public int Count { get; }

        /// <summary>Instances of a direct draw; the engine multiplies them if it draws both eyes by instancing.</summary>
        public int Instances { get; }

        /// <summary>A draw of `count` vertices, or of `count` indices where `indices` are given.</summary>
        public static AvatarDraw Direct(
            Material material, int pass, MaterialPropertyBlock properties, int count, GraphicsBuffer indices = null)
        {
            return new AvatarDraw(material, pass, properties, indices, null, count, 1);
        }

        /// <summary>As many vertices and instances as the device has written to `arguments`.</summary>
        public static AvatarDraw Indirect(
            Material material, int pass, MaterialPropertyBlock properties, GraphicsBuffer arguments)
        {
            return new AvatarDraw(material, pass, properties, null, arguments, 0, 0);
        }

        /// <summary>Appends the draw.</summary>
        public void Append(CommandBuffer commands)
        {
            Matrix4x4 place = Matrix4x4.identity;
            if (Arguments != null)
            {
                commands.DrawProceduralIndirect(
                    place, Material, Pass, MeshTopology.Triangles, Arguments, 0, Properties);
            }
            else if (Indices != null)
            {
                commands.DrawProcedural(
                    Indices, place, Material, Pass, MeshTopology.Triangles, Count, Instances, Properties);
            }
            else
            {
                commands.DrawProcedural(place, Material, Pass, MeshTopology.Triangles, Count, Instances, Properties);
            }
        }

        private AvatarDraw(
            Material material, int pass, MaterialPropertyBlock properties, GraphicsBuffer indices,
            GraphicsBuffer arguments, int count, int instances)
        {
            Material = material;
            Pass = pass;
            Properties = properties;
            Indices = indices;
            Arguments = arguments;
            Count = count;
            Instances = instances;
        }
    }
}
