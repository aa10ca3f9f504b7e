using System;
using System.Collections.Generic;
using UnityEngine;
using UnityEngine.Rendering;

namespace Mua
{
    /// <summary>
    /// All avatars that are ready, and what they share: kernels, one sort, one draw. It lives as long as there is one.
    /// Whoever draws a camera calls Record for it, then draws Draws.
    /// </summary>
    internal sealed class AvatarWorld : IDisposable
    {
        private const string Universal = "UniversalRenderPipelineAsset"; // an optional package's; AvatarUrp draws there

        private static readonly HashSet<string> Reported = new HashSet<string>();

        private readonly AvatarResources resources;
        private readonly List<AvatarInstance> avatars = new List<AvatarInstance>();
        private readonly List<AvatarFrame> frames = new List<AvatarFrame>();
        private readonly List<AvatarDraw> draws = new List<AvatarDraw>();
        private readonly AvatarLevels levels = new AvatarLevels();
        private readonly AvatarTurns turns = new AvatarTurns();
        private readonly SplatDraw splatDraw;
        private readonly AvatarBuiltIn builtIn;
        private SplatFrame splats;
        private bool hasChanged; // avatars came or went

        private AvatarWorld(AvatarResources resources)
        {
            this.resources = resources;
            splatDraw = new SplatDraw(resources.Splat);
            builtIn = new AvatarBuiltIn(this);
        }

        /// <summary>The one world, or null while no avatar is ready.</summary>
        public static AvatarWorld Current { get; private set; }

        /// <summary>What the last Record found to draw, in this order.</summary>
        public IReadOnlyList<AvatarDraw> Draws => draws;

        /// <summary>Splats that are sorted together.</summary>
        public int SplatCount => splats == null ? 0 : splats.SplatCount;

        /// <summary>Takes an avatar whose buffers are on the device. InvalidOperationException: the package lacks a shader.</summary>
        public static void Add(AvatarInstance avatar, AvatarResources resources)
        {
            if (Current == null)
            {
                Current = new AvatarWorld(resources);
            }
            Current.avatars.Add(avatar);
            Current.hasChanged = true;
            RenderPipelineAsset pipeline = GraphicsSettings.currentRenderPipeline;
            if (pipeline != null && pipeline.GetType().Name != Universal)
            {
                Report(
                    pipeline.GetType().Name + " cannot draw avatars; use URP or the built-in render pipeline.", pipeline);
            }
        }

        public static void Remove(AvatarInstance avatar)
        {
            if (Current == null || !Current.avatars.Remove(avatar))
            {
                return;
            }
            Current.hasChanged = true;
            Current.draws.Clear(); // they may hold the avatar's buffers
            Current.builtIn.Clear();
            if (Current.avatars.Count == 0)
            {
                Current.Dispose();
            }
        }

        /// <summary>Makes the next Record sort the avatars that are shown by then.</summary>
        public static void Refresh()
        {
            if (Current != null)
            {
                Current.hasChanged = true;
            }
        }

        /// <summary>Logs an error, once however often it is found.</summary>
        public static void Report(string sentence, UnityEngine.Object context)
        {
            if (Reported.Add(sentence))
            {
                Debug.LogError("MUA: " + sentence, context);
            }
        }

        /// <summary>
        /// Appends what one camera needs of the avatars in its view: decoding and posing what moved since it was last drawn, then
        /// one sort for the eyes. An avatar is posed where its shadow alone may be in view, too; several take turns to be decoded.
        /// Whether there is anything to draw; splats are projected in perspective only.
        /// </summary>
        public bool Record(CommandBuffer commands, Camera camera, AvatarEyes eyes)
        {
            draws.Clear();
            if (hasChanged)
            {
                hasChanged = false;
                Share();
            }
            if (splats == null || !IsSeen(camera))
            {
                return false;
            }
            for (int i = 0; i < avatars.Count; i++)
            {
                avatars[i].Decoded.IsShown = avatars[i].Sight.IsShownTo(camera);
            }
            levels.See(avatars, eyes, turns.Limit);
            turns.Take(commands, avatars, camera, eyes);
            for (int i = 0; i < avatars.Count; i++)
            {
                avatars[i].Decoded.IsShown &= avatars[i].Decoded.IsDecoded; // it may be another's turn
                if (avatars[i].Sight.IsNeededFor(eyes))
                {
                    avatars[i].Record(commands);
                }
            }
            bool perspective = !camera.orthographic;
            if ((perspective && splats.Capacity > 0) || ShowsGeometry()) // which is drawn through the splats' centres
            {
                splats.Project(commands, eyes);
            }
            AddSurfaces(eyes, true);
            if (perspective && splats.SplatCount > 0)
            {
                splats.Sort(commands);
                draws.Add(splatDraw.Bind(splats));
            }
            AddSurfaces(eyes, false);
            return draws.Count > 0;
        }

        /// <summary>
        /// Whether the camera shows any avatar. Previews of assets show none.
        /// </summary>
        public bool IsSeen(Camera camera)
        {
            if (camera.cameraType == CameraType.Preview)
            {
                return false;
            }
            for (int i = 0; i < avatars.Count; i++)
            {
                if (avatars[i].Sight.IsShownTo(camera))
                {
                    return true;
                }
            }
            return false;
        }

        public void Dispose()
        {
            builtIn.Dispose();
            Release();
            draws.Clear();
            splatDraw.Dispose();
            if (Current == this)
            {
                Current = null;
            }
        }

        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void Restart()
        {
            Reported.Clear(); // avatars that outlive the start of a game without a reload stay in their world
        }

        /// <summary>
        /// One set of shared buffers for the avatars that there are now, those whose splats are drawn first. Where they
        /// are too large for the device, the avatar that was added last is ended.
        /// </summary>
        private void Share()
        {
            Release();
            frames.Clear();
            levels.Restart(avatars.Count);
            AddFrames(true);
            int shown = frames.Count;
            AddFrames(false);
            try
            {
                splats = frames.Count == 0 ? null : new SplatFrame(resources, frames, shown);
            }
            catch (InvalidOperationException error)
            {
                avatars[avatars.Count - 1].Refuse(error.Message);
            }
        }

        /// <summary>What lies behind the splats, or over them, of the avatars that the eyes see.</summary>
        private void AddSurfaces(AvatarEyes eyes, bool opaque)
        {
            for (int i = 0; i < avatars.Count; i++)
            {
                AvatarInstance avatar = avatars[i];
                if (!avatar.Sight.IsSeenBy(eyes))
                {
                    continue;
                }
                if (opaque)
                {
                    avatar.Surface.AddOpaque(draws, eyes, avatar.Views);
                }
                else
                {
                    avatar.Surface.AddOverlay(draws, eyes, avatar.Views);
                }
            }
        }

        private bool ShowsGeometry()
        {
            for (int i = 0; i < avatars.Count; i++)
            {
                if ((avatars[i].Views & AvatarViews.Geometry) != 0)
                {
                    return true;
                }
            }
            return false;
        }

        private void AddFrames(bool withSplats)
        {
            for (int i = 0; i < avatars.Count; i++)
            {
                if (withSplats == ((avatars[i].Views & AvatarViews.Splats) != 0))
                {
                    frames.Add(avatars[i].Decoded);
                    avatars[i].MarkMoved();
                }
            }
        }

        private void Release()
        {
            if (splats != null)
            {
                splats.Dispose();
                splats = null;
            }
        }
    }
}
