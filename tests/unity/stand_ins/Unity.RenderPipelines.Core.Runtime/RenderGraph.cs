// Stand-in. Source: Unity's Graphics repository, com.unity.render-pipelines.core 17.0 (ExtendedFeatureFlags: 17.2),
// Runtime/RenderGraph: passes run in the order of recording, and those that nothing is seen to need are culled.
using System;
using System.Collections.Generic;

namespace UnityEngine.Rendering.RenderGraphModule
{
    [Flags] public enum AccessFlags { None = 0, Read = 1, Write = 2, Discard = 4, WriteAll = Write | Discard, ReadWrite = Read | Write }
    [Flags] public enum ExtendedFeatureFlags { None = 0, TileProperties = 1, MultiviewRenderRegionsCompatible = 2 }

    public struct TextureHandle
    {
        internal string Name;

        public bool IsValid() { return Name != null; }
        public static TextureHandle nullHandle { get { return new TextureHandle(); } }

        /// <summary>Not Unity's: a target of that name.</summary>
        public static TextureHandle Of(string name) { return new TextureHandle { Name = name }; }
    }

    public struct RasterGraphContext { public RasterCommandBuffer cmd; }
    public class UnsafeGraphContext { public UnsafeCommandBuffer cmd; }

    public delegate void BaseRenderFunc<PassData, ContextType>(PassData data, ContextType renderGraphContext) where PassData : class, new();

    public interface IBaseRenderGraphBuilder : IDisposable
    {
        void UseTexture(in TextureHandle input, AccessFlags flags = AccessFlags.Read);
        void AllowPassCulling(bool value);
        void AllowGlobalStateModification(bool value);
        void EnableFoveatedRasterization(bool value);
        void EnableAsyncCompute(bool value);
    }

    public interface IUnsafeRenderGraphBuilder : IBaseRenderGraphBuilder
    {
        void SetRenderFunc<PassData>(BaseRenderFunc<PassData, UnsafeGraphContext> renderFunc) where PassData : class, new();
    }

    public interface IRasterRenderGraphBuilder : IBaseRenderGraphBuilder
    {
        void SetRenderAttachment(TextureHandle tex, int index, AccessFlags flags = AccessFlags.Write);
        void SetRenderAttachmentDepth(TextureHandle tex, AccessFlags flags = AccessFlags.Write);
        void SetExtendedFeatureFlags(ExtendedFeatureFlags extendedFeatureFlags);
        void SetRenderFunc<PassData>(BaseRenderFunc<PassData, RasterGraphContext> renderFunc) where PassData : class, new();
    }

    public class RenderGraph
    {
        private readonly List<Pass> recorded = new List<Pass>();
        private readonly Dictionary<Type, Stack<Pass>> free = new Dictionary<Type, Stack<Pass>>();
        private readonly Dictionary<Action<CommandBuffer>, Step> steps = new Dictionary<Action<CommandBuffer>, Step>();

        public IUnsafeRenderGraphBuilder AddUnsafePass<PassData>(string passName, out PassData passData, ProfilingSampler sampler) where PassData : class, new()
        {
            return Add<PassData>(passName, false, out passData);
        }
        public IRasterRenderGraphBuilder AddRasterRenderPass<PassData>(string passName, out PassData passData, ProfilingSampler sampler) where PassData : class, new()
        {
            return Add<PassData>(passName, true, out passData);
        }

        /// <summary>Not Unity's: a step of the pipeline itself.</summary>
        public void AddStep(Action<CommandBuffer> step)
        {
            Step held;
            if (!steps.TryGetValue(step, out held))
                steps[step] = held = new Step { Run = step };
            recorded.Add(held);
        }

        /// <summary>Not Unity's: run what was recorded, and forget it.</summary>
        public void Execute(CommandBuffer commands)
        {
            for (int i = 0; i < recorded.Count; i++)
            {
                if (!recorded[i].IsCulled)
                    recorded[i].Execute(commands);
                recorded[i].Return();
            }
            recorded.Clear();
        }

        private Pass<PassData> Add<PassData>(string name, bool isRaster, out PassData data) where PassData : class, new()
        {
            Stack<Pass> pool;
            if (!free.TryGetValue(typeof(PassData), out pool))
                free[typeof(PassData)] = pool = new Stack<Pass>();
            Pass<PassData> pass = pool.Count > 0 ? (Pass<PassData>)pool.Pop() : new Pass<PassData> { Pool = pool };
            pass.Begin(name, isRaster);
            recorded.Add(pass);
            data = pass.Content;
            return pass;
        }

        private abstract class Pass
        {
            public Stack<Pass> Pool;

            public virtual bool IsCulled { get { return false; } }
            public abstract void Execute(CommandBuffer commands);
            public void Return()
            {
                if (Pool != null)
                    Pool.Push(this);
            }
        }

        private sealed class Step : Pass
        {
            public Action<CommandBuffer> Run;

            public override void Execute(CommandBuffer commands) { Run(commands); }
        }

        private sealed class Pass<PassData> : Pass, IUnsafeRenderGraphBuilder, IRasterRenderGraphBuilder where PassData : class, new()
        {
            public readonly PassData Content = new PassData();
            private readonly RasterCommandBuffer raster = new RasterCommandBuffer();
            private readonly UnsafeGraphContext context = new UnsafeGraphContext { cmd = new UnsafeCommandBuffer() };
            private BaseRenderFunc<PassData, UnsafeGraphContext> unsafeFunc;
            private BaseRenderFunc<PassData, RasterGraphContext> rasterFunc;
            private bool isRaster, canBeCulled, isRecorded, isFoveated, global;
            private string name;
            private TextureHandle color, depth;
            private AccessFlags colorFlags, depthFlags;
            private ExtendedFeatureFlags features;

            public override bool IsCulled { get { return canBeCulled && !color.IsValid(); } }

            public void Begin(string name, bool isRaster)
            {
                this.name = name;
                this.isRaster = isRaster;
                canBeCulled = true;
                isRecorded = isFoveated = global = false;
                unsafeFunc = null;
                rasterFunc = null;
                color = depth = TextureHandle.nullHandle;
                features = ExtendedFeatureFlags.None;
            }

            public void UseTexture(in TextureHandle input, AccessFlags flags) { CheckOpen(); }
            public void AllowPassCulling(bool value) { CheckOpen(); canBeCulled = value; }
            public void AllowGlobalStateModification(bool value) { CheckOpen(); global = value; }
            public void EnableFoveatedRasterization(bool value) { CheckOpen(); isFoveated = value; }
            public void EnableAsyncCompute(bool value) { CheckOpen(); }
            public void SetExtendedFeatureFlags(ExtendedFeatureFlags extendedFeatureFlags) { CheckOpen(); features |= extendedFeatureFlags; }
            void IUnsafeRenderGraphBuilder.SetRenderFunc<T>(BaseRenderFunc<T, UnsafeGraphContext> renderFunc)
            {
                CheckOpen();
                unsafeFunc = (BaseRenderFunc<PassData, UnsafeGraphContext>)(object)renderFunc;
            }
            void IRasterRenderGraphBuilder.SetRenderFunc<T>(BaseRenderFunc<T, RasterGraphContext> renderFunc)
            {
                CheckOpen();
                rasterFunc = (BaseRenderFunc<PassData, RasterGraphContext>)(object)renderFunc;
            }
            public void SetRenderAttachment(TextureHandle tex, int index, AccessFlags flags)
            {
                CheckOpen();
                CheckTarget(tex);
                color = tex;
                colorFlags = flags;
            }
            public void SetRenderAttachmentDepth(TextureHandle tex, AccessFlags flags)
            {
                CheckOpen();
                CheckTarget(tex);
                depth = tex;
                depthFlags = flags;
            }

            public void Dispose()
            {
                if (unsafeFunc == null && rasterFunc == null)
                    throw new InvalidOperationException("RenderPass " + name + " was not provided with an execute function.");
                if (isRaster && !color.IsValid() && !depth.IsValid())
                    throw new InvalidOperationException("RenderPass " + name + " has no render targets.");
                isRecorded = true;
            }

            public override void Execute(CommandBuffer commands)
            {
                if (!isRecorded)
                    throw new InvalidOperationException("RenderPass " + name + " was executed before its builder was disposed.");
                StandIns.Pipelines.Note(commands, isRaster ? Described() : name);
                if (isRaster)
                {
                    raster.Wrapped = commands;
                    rasterFunc(Content, new RasterGraphContext { cmd = raster });
                    raster.Wrapped = null; // what is used after its pass fails
                    return;
                }
                context.cmd.Wrapped = commands;
                unsafeFunc(Content, context);
                context.cmd.Wrapped = null;
            }

            private string Described()
            {
                if (!StandIns.Recorder.IsOn)
                    return name;
                string targets = color.Name + " " + colorFlags + (depth.IsValid() ? ", " + depth.Name + " " + depthFlags : "");
                return name + ": " + targets + (isFoveated ? ", foveated" : "") + (global ? ", global" : "") + (features == 0 ? "" : ", " + features);
            }

            private void CheckOpen()
            {
                if (isRecorded)
                    throw new InvalidOperationException("the builder of " + name + " was used after Dispose.");
            }

            private static void CheckTarget(TextureHandle tex)
            {
                if (!tex.IsValid())
                    throw new ArgumentException("Trying to use an invalid resource as a render target.");
            }
        }
    }
}
