using System;
using System.Collections.Generic;
using UnityEngine;

namespace Mua
{
    /// <summary>
    /// Chooses the levels of detail of all avatars in view together, once in a frame: for the camera to which each is nearest,
    /// of those of the last frame and the first of this one.
    /// </summary>
    internal sealed class AvatarLevels
    {
        private AvatarSeen[] nearest = new AvatarSeen[0], chosen = new AvatarSeen[0];
        private int[] places = new int[0], order = new int[0]; // of the chosen, among the avatars
        private int frame = -1;

        /// <summary>Makes room for other avatars, which no camera has seen yet.</summary>
        public void Restart(int count)
        {
            nearest = new AvatarSeen[count];
            chosen = new AvatarSeen[count];
            places = new int[count];
            order = new int[count];
            frame = -1;
            for (int i = 0; i < count; i++)
            {
                nearest[i] = Unseen(nearest[i]);
            }
        }

        /// <summary>Takes what the eyes of one camera see, and chooses where it is the first of a frame.</summary>
        /// <param name="budget">Splats of all together; negative for as many as there are.</param>
        public void See(IReadOnlyList<AvatarInstance> avatars, AvatarEyes eyes, long budget)
        {
            bool isFirst = frame != Time.frameCount;
            frame = Time.frameCount;
            int count = 0;
            for (int i = 0; i < avatars.Count; i++)
            {
                AvatarSeen now = avatars[i].Sight.Seen(eyes), before = nearest[i];
                now.Level = avatars[i].Level;
                if (!avatars[i].Sight.IsSeenBy(eyes))
                {
                    now = Unseen(now);
                }
                AvatarSeen both = now;
                both.Distance = Math.Min(now.Distance, before.Distance);
                both.Texel = Math.Max(now.Texel, before.Texel);
                nearest[i] = isFirst ? now : both;
                if (both.Distance == double.MaxValue)
                {
                    continue; // it costs nothing
                }
                if (avatars[i].ChoosesLevel)
                {
                    places[count] = i;
                    chosen[count++] = both;
                }
                else if (budget >= 0 && (avatars[i].Views & AvatarViews.Splats) != 0)
                {
                    budget = Math.Max(budget - now.Counts[avatars[i].Level], 0);
                }
            }
            if (isFirst)
            {
                LevelChoice.Choose(new Span<AvatarSeen>(chosen, 0, count), new Span<int>(order, 0, count), budget);
                for (int i = 0; i < count; i++)
                {
                    avatars[places[i]].Level = chosen[i].Level;
                }
            }
        }

        private static AvatarSeen Unseen(AvatarSeen seen)
        {
            seen.Distance = double.MaxValue;
            seen.Texel = 0;
            return seen;
        }
    }
}
