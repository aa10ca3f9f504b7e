using System;
using System.Collections.Generic;
using UnityEngine;
using UnityEngine.Rendering;

namespace Mua
{
    /// <summary>
    /// The decodes of all avatars in view, once in a displayed frame: what the schedule plans, within what the device has been
    /// found to have time for.
    /// </summary>
    internal sealed class AvatarTurns
    {
        private const double Second = 1000; // in milliseconds

        private readonly DecodeSchedule schedule = new DecodeSchedule();
        private readonly FrameBudget budget = new FrameBudget();
        private readonly FrameTiming[] timings = new FrameTiming[1];
        private readonly List<AvatarInstance> asked = new List<AvatarInstance>();
        private readonly List<DecodeTurn> turns = new List<DecodeTurn>();
        private int frame = -1;
        private int spent; // parts in this displayed frame
        private int inView, shown, finest; // avatars; their splats whose level is automatic

        /// <summary>Splats of all avatars together; negative for as many as there are.</summary>
        public long Limit
        {
            get
            {
                long limit = AvatarBudget.Limit;
                bool isLimited = AvatarBudget.FrameLimit > 0 && budget.Splats >= 0;
                return !isLimited ? limit : limit < 0 ? budget.Splats : Math.Min(limit, budget.Splats);
            }
        }

        /// <summary>Appends the decodes of the avatars that one camera needs, or that others do.</summary>
        public void Take(CommandBuffer commands, IReadOnlyList<AvatarInstance> avatars, Camera camera, AvatarEyes eyes)
        {
            if (frame != Time.frameCount)
            {
                frame = Time.frameCount;
                spent = 0;
                Measure();
            }
            Gather(avatars, camera, eyes);
            bool alone = inView == 1;
            for (int i = 0; i < asked.Count; i++)
            {
                asked[i].Ask(eyes, alone);
            }
            spent += schedule.Plan(turns, frame, budget.Parts - spent, alone);
            for (int i = 0; i < asked.Count; i++)
            {
                asked[i].Decode(commands);
            }
        }

        private void Gather(IReadOnlyList<AvatarInstance> avatars, Camera camera, AvatarEyes eyes)
        {
            asked.Clear();
            turns.Clear();
            inView = shown = finest = 0;
            for (int i = 0; i < avatars.Count; i++)
            {
                AvatarInstance avatar = avatars[i];
                if (!avatar.Sight.IsNeeded(camera, eyes))
                {
                    continue;
                }
                inView++;
                if (avatar.ChoosesLevel)
                {
                    shown += avatar.Decoded.SplatCount;
                    finest += avatar.Decoded.Avatar.SplatCounts[0];
                }
                if (avatar.IsDue)
                {
                    asked.Add(avatar);
                    turns.Add(avatar.Turn);
                }
            }
        }

        /// <summary>Takes how long the last frame took, where that matters.</summary>
        private void Measure()
        {
            float asks = AvatarBudget.FrameLimit;
            if (!Application.isPlaying || (inView < 2 && asks <= 0))
            {
                return;
            }
            FrameTimingManager.CaptureFrameTimings();
            bool exact = FrameTimingManager.GetLatestTimings(1, timings) == 1 && timings[0].gpuFrameTime > 0;
            double taken = exact ? timings[0].gpuFrameTime : Second * Time.unscaledDeltaTime;
            double most = asks > 0 ? asks : FrameBudget.Milliseconds;
            budget.Measure(taken, most, exact, inView, asks > 0 ? shown : -1, finest);
        }
    }
}
