using System;
using System.Collections.Generic;
using System.Threading.Tasks;
using Mua.Format;
using UnityEngine;
using UnityEngine.Rendering;

namespace Mua
{
    /// <summary>
    /// What is drawn of one avatar beside its splats: detailed geometry, template, bones, cast shadow. The buffers of
    /// a view are made when it is first wanted, the texel grid on another thread; one that fails is reported once.
    /// </summary>
    internal sealed class AvatarSurface : IDisposable
    {
        private readonly AvatarResources resources;
        private readonly AvatarFrame frame;
        private readonly BufferSet buffers = new BufferSet();
        private SurfaceDraw draw;
        private Task<TexelGrid> building;
        private GraphicsBuffer ringStarts, ring, gridIndices; // of the geometry
        private GraphicsBuffer templateIndices;
        private GraphicsBuffer rest, strokes; // of the bones
        private AvatarViews refused;

        public AvatarSurface(AvatarResources resources, AvatarFrame frame)
        {
            this.resources = resources;
            this.frame = frame;
        }

        /// <summary>Adds what is drawn before the splats: geometry and template, which write depth.</summary>
        public void AddOpaque(List<AvatarDraw> draws, AvatarEyes eyes, AvatarViews views)
        {
            if (IsReady(views, AvatarViews.Geometry))
            {
                draws.Add(draw.BindGeometry(frame, eyes, ringStarts, ring, gridIndices));
            }
            if (IsReady(views, AvatarViews.Template))
            {
                draws.Add(draw.BindTemplate(frame, eyes, templateIndices));
            }
        }

        /// <summary>Adds what is drawn over all else: the bones.</summary>
        public void AddOverlay(List<AvatarDraw> draws, AvatarEyes eyes, AvatarViews views)
        {
            if (IsReady(views, AvatarViews.Skeleton))
            {
                draws.Add(draw.BindSkeleton(frame, eyes, rest, strokes));
            }
        }

        /// <summary>Makes the lights of this frame draw the template, in a box of Unity's world, metres.</summary>
        public void CastShadow(AvatarViews views, Bounds bounds, GameObject owner)
        {
            if (!frame.IsDecoded || !IsReady(views, AvatarViews.Shadow))
            {
                return;
            }
            var parameters = new RenderParams(draw.Material)
            {
                layer = owner.layer,
                worldBounds = bounds,
                matProps = draw.BindShadow(frame),
                shadowCastingMode = ShadowCastingMode.ShadowsOnly,
                receiveShadows = false,
            };
#if UNITY_EDITOR
            parameters.overrideSceneCullingMask = true; // an opened prefab and the scene cast none into each other
            parameters.sceneCullingMask = owner.sceneCullingMask;
            if (UnityEditor.SceneVisibilityManager.instance.IsHidden(owner)) // in scene views
            {
                parameters.sceneCullingMask &= UnityEditor.SceneManagement.SceneCullingMasks.GameViewObjects;
            }
#endif
            Graphics.RenderPrimitivesIndexed(parameters, MeshTopology.Triangles, templateIndices, templateIndices.count);
        }

        public void Dispose()
        {
            buffers.Dispose();
            draw?.Dispose();
            draw = null;
            building = null; // what it makes holds no GPU memory
            refused = ~AvatarViews.None;
        }

        /// <summary>Whether a view is among those wanted and its buffers are there; makes them where they are not.</summary>
        private bool IsReady(AvatarViews views, AvatarViews view)
        {
            if ((views & view & ~refused) == 0)
            {
                return false;
            }
            try
            {
                draw = draw ?? new SurfaceDraw(resources.Surface);
                switch (view)
                {
                    case AvatarViews.Geometry:
                        return MakeGrid();
                    case AvatarViews.Skeleton:
                        return MakeBones();
                    default:
                        return MakeMesh();
                }
            }
            catch (Exception error) // whatever it is: the user sees one sentence, and no frame tries again
            {
                refused |= view;
                AvatarWorld.Report(
                    frame.Avatar.Avatar.Name + " cannot show its " + view + ": " + error.GetBaseException().Message, null);
                return false;
            }
        }

        private bool MakeGrid()
        {
            if (gridIndices != null)
            {
                return true;
            }
            building = building ?? StartGrid(frame.Avatar.Avatar);
            if (!building.IsCompleted && Application.isPlaying)
            {
                return false;
            }
            TexelGrid grid = building.Result; // an editor that does not play waits here
            building = null;
            if (grid.Triangles.Length == 0)
            {
                refused |= AvatarViews.Geometry; // nothing to draw
                return false;
            }
            ringStarts = buffers.Structured("ring_starts", grid.RingStarts.Length, sizeof(uint));
            ring = buffers.Structured("ring", grid.Ring.Length / 2, 2 * sizeof(uint));
            GraphicsBuffer indices = buffers.Indices("grid_indices", grid.Triangles.Length);
            ringStarts.SetData(grid.RingStarts);
            ring.SetData(grid.Ring);
            indices.SetData(grid.Triangles);
            gridIndices = indices;
            return true;
        }

        private static Task<TexelGrid> StartGrid(AvatarFile avatar)
        {
            return Task.Run(() => TexelGrid.Build(avatar));
        }

        private bool MakeMesh()
        {
            if (templateIndices == null)
            {
                int[] corners = frame.Avatar.Avatar.Template.Faces.Integers.ToArray();
                GraphicsBuffer indices = buffers.Indices("mesh_indices", corners.Length);
                indices.SetData(corners);
                templateIndices = indices;
            }
            return true;
        }

        /// <summary>A stroke for each bone and a dot for each joint, each first as its outline.</summary>
        private bool MakeBones()
        {
            if (strokes != null)
            {
                return true;
            }
            Skeleton skeleton = frame.Avatar.Avatar.Skeleton;
            var ends = new List<int>();
            for (int style = SurfaceDraw.BoneOutline; style <= SurfaceDraw.Joint; style++)
            {
                for (int joint = 0; joint < skeleton.JointCount; joint++)
                {
                    int other = style <= SurfaceDraw.Bone ? skeleton.Parents[joint] : joint;
                    if (other >= 0)
                    {
                        ends.AddRange(new[] { joint, other, style, 0 });
                    }
                }
            }
            rest = buffers.Structured("rest", skeleton.JointCount, 4 * sizeof(float));
            rest.SetData(RestOf(skeleton));
            GraphicsBuffer made = buffers.Structured("strokes", ends.Count / 4, 4 * sizeof(uint));
            made.SetData(ends.ToArray());
            strokes = made;
            return true;
        }

        /// <summary>Positions of the joints in the bind pose, metres.</summary>
        private static Vector4[] RestOf(Skeleton skeleton)
        {
            var turned = new double[4 * skeleton.JointCount];
            var placed = new double[3 * skeleton.JointCount];
            skeleton.World(skeleton.BindRotations, skeleton.BindTranslations, turned, placed);
            var positions = new Vector4[skeleton.JointCount];
            for (int joint = 0; joint < positions.Length; joint++)
            {
                Vector3D at = Vector3D.Load(placed, joint);
                positions[joint] = new Vector4((float)at.X, (float)at.Y, (float)at.Z, 1);
            }
            return positions;
        }
    }
}
