using System;
using UnityEngine;

namespace Mua
{
    /// <summary>
    /// The draws of one avatar's surfaces and bones: Shaders/surface.shader over ComputeShaders/surface_draw.hlsl, in the
    /// colours of python/mua/player/overlays.py. Each pass has properties of its own: draws are run after all are bound.
    /// </summary>
    internal sealed class SurfaceDraw : IDisposable
    {
        /// <summary>Styles of strokes, in the order in which they are drawn.</summary>
        public const int BoneOutline = 0, Bone = 1, JointOutline = 2, Joint = 3;

        private const string File = "the surface shader";
        private const int GeometryPass = 0, TemplatePass = 1, SkeletonPass = 2;
        private const int VerticesPerStroke = 6;
        private const float BoneWidth = 2.5f, JointWidth = 5, Outline = 1.5f; // pixels

        private static readonly int Splats = Shader.PropertyToID("splats");
        private static readonly int RingStarts = Shader.PropertyToID("ring_starts");
        private static readonly int Ring = Shader.PropertyToID("ring");
        private static readonly int VertexDq = Shader.PropertyToID("vertex_dq");
        private static readonly int Mesh = Shader.PropertyToID("mesh");
        private static readonly int Joints = Shader.PropertyToID("joints");
        private static readonly int Rest = Shader.PropertyToID("rest");
        private static readonly int Strokes = Shader.PropertyToID("strokes");
        private static readonly int ViewProjection = Shader.PropertyToID("view_projection");
        private static readonly int Cameras = Shader.PropertyToID("cameras");
        private static readonly int Color = Shader.PropertyToID("color");
        private static readonly int Styles = Shader.PropertyToID("styles");
        private static readonly int Screen = Shader.PropertyToID("screen");
        private static readonly int Size = Shader.PropertyToID("size");
        private static readonly int FirstSplat = Shader.PropertyToID("first_splat");
        private static readonly int EyeCount = Shader.PropertyToID("eye_count");

        private static readonly Vector4 GeometryColor = new Vector4(0.80f, 0.78f, 0.75f, 1); // sRGB, as all here
        private static readonly Vector4 TemplateColor = new Vector4(0.62f, 0.72f, 0.84f, 1);
        private static readonly Vector4[] StrokeStyles = // and width
        {
            new Vector4(0.12f, 0.10f, 0.08f, BoneWidth + 2 * Outline),
            new Vector4(0.98f, 0.62f, 0.12f, BoneWidth),
            new Vector4(0.12f, 0.10f, 0.08f, JointWidth + 2 * Outline),
            new Vector4(1, 0.97f, 0.90f, JointWidth),
        };

        private readonly MaterialPropertyBlock geometry = new MaterialPropertyBlock();
        private readonly MaterialPropertyBlock template = new MaterialPropertyBlock();
        private readonly MaterialPropertyBlock skeleton = new MaterialPropertyBlock();
        private readonly MaterialPropertyBlock shadow = new MaterialPropertyBlock();

        /// <summary>InvalidOperationException where the shader is missing or the device cannot run it.</summary>
        public SurfaceDraw(Shader shader)
        {
            if (shader == null || !shader.isSupported)
            {
                throw new InvalidOperationException(
                    File + " is missing, or " + SystemInfo.graphicsDeviceName + " cannot run it.");
            }
            Material = new Material(shader) { name = "MUA surface", hideFlags = HideFlags.HideAndDontSave };
        }

        public Material Material { get; private set; }

        /// <summary>The surface through the splats' centres: a ring of triangles about each texel.</summary>
        public AvatarDraw BindGeometry(
            AvatarFrame frame, AvatarEyes eyes, GraphicsBuffer ringStarts, GraphicsBuffer ring, GraphicsBuffer indices)
        {
            geometry.SetBuffer(Splats, frame.Splats);
            geometry.SetBuffer(RingStarts, ringStarts);
            geometry.SetBuffer(Ring, ring);
            geometry.SetInteger(FirstSplat, frame.FirstSplat);
            geometry.SetVector(Color, GeometryColor);
            Bind(geometry, eyes);
            return AvatarDraw.Direct(Material, GeometryPass, geometry, indices.count, indices);
        }

        /// <summary>The posed template.</summary>
        public AvatarDraw BindTemplate(AvatarFrame frame, AvatarEyes eyes, GraphicsBuffer indices)
        {
            template.SetBuffer(VertexDq, frame.VertexDq);
            template.SetBuffer(Mesh, frame.Mesh);
            template.SetFloat(Size, frame.Size);
            template.SetVector(Color, TemplateColor);
            Bind(template, eyes);
            return AvatarDraw.Direct(Material, TemplatePass, template, indices.count, indices);
        }

        /// <summary>The bones.</summary>
        public AvatarDraw BindSkeleton(AvatarFrame frame, AvatarEyes eyes, GraphicsBuffer rest, GraphicsBuffer strokes)
        {
            skeleton.SetBuffer(Joints, frame.Joints);
            skeleton.SetFloat(Size, frame.Size);
            skeleton.SetBuffer(Rest, rest);
            skeleton.SetBuffer(Strokes, strokes);
            skeleton.SetVectorArray(Styles, StrokeStyles);
            skeleton.SetVector(Screen, new Vector4(eyes.Screen[0], eyes.Screen[1], 0, 0));
            Bind(skeleton, eyes);
            return AvatarDraw.Direct(Material, SkeletonPass, skeleton, VerticesPerStroke * strokes.count);
        }

        /// <summary>What draws the posed template into the maps of lights.</summary>
        public MaterialPropertyBlock BindShadow(AvatarFrame frame)
        {
            shadow.SetBuffer(VertexDq, frame.VertexDq);
            shadow.SetBuffer(Mesh, frame.Mesh);
            shadow.SetFloat(Size, frame.Size);
            return shadow;
        }

        public void Dispose()
        {
            if (Material != null)
            {
                UnityEngine.Object.DestroyImmediate(Material);
                Material = null;
            }
        }

        private static void Bind(MaterialPropertyBlock properties, AvatarEyes eyes)
        {
            properties.SetMatrixArray(ViewProjection, eyes.DeviceViewProjection);
            properties.SetVectorArray(Cameras, eyes.Positions);
            properties.SetInteger(EyeCount, eyes.Count);
        }
    }
}
