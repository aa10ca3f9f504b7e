using System;

namespace Mua
{
    /// <summary>
    /// How many parts of decodes and how many splats a displayed frame may hold, by how long frames took on this device.
    /// As python/mua/avatar/frame_budget.py; tests hold both to it.
    /// </summary>
    internal sealed class FrameBudget
    {
        /// <summary>Milliseconds of a frame where nothing else is asked for: a headset's.</summary>
        public const double Milliseconds = 1000.0 / 72;

        private const int Window = 36; // displayed frames from one decision to the next
        private const int Few = 3; // frames of a window that may be longer, whatever else delayed them
        private const double Room = 0.8; // share of the budget that frames stay below before there is room for more
        private const double Missed = 1.25; // times the budget; displayed frames that took longer missed their time
        private const double Step = 0.8; // share of the splats that is left after a decision for fewer
        private const int Patience = 64; // windows with room before more is tried, at most

        private int frames;
        private int over; // of these, longer than the budget
        private int near; // of these, without room for more
        private int roomy; // windows with room, one after the other
        private int patience = 1; // windows with room before more is tried
        private bool isRaised; // by the last decision

        /// <summary>Parts of decodes.</summary>
        public int Parts { get; private set; } = 1;

        /// <summary>Splats of all avatars together; negative for no limit.</summary>
        public int Splats { get; private set; } = -1;

        /// <summary>Takes how long a frame took.</summary>
        /// <param name="milliseconds">That it took.</param>
        /// <param name="most">That it may take.</param>
        /// <param name="exact">Measured by the graphics device; else from one displayed frame to the next.</param>
        /// <param name="avatars">In view.</param>
        /// <param name="shown">Splats that are shown; negative where no limit is to be set.</param>
        /// <param name="finest">Splats of the finest levels.</param>
        public void Measure(double milliseconds, double most, bool exact, int avatars, int shown, int finest)
        {
            bool isOver = milliseconds > most * (exact ? 1 : Missed);
            over += isOver ? 1 : 0;
            near += isOver || (exact && milliseconds > Room * most) ? 1 : 0;
            if (++frames < Window)
            {
                return;
            }
            bool wasOver = over >= Few, wasNear = near >= Few;
            frames = over = near = 0;
            int all = ChannelDecoder.Parts * avatars; // parts of a decode of each
            int least = shown < 0 ? 1 : Math.Max((all + DecodeSchedule.Longest - 1) / DecodeSchedule.Longest, 1); // by which none waits longer
            if (wasOver)
            {
                Lower(least, shown);
            }
            else if (wasNear && Parts >= least)
            {
                roomy = 0;
            }
            else if (++roomy >= patience)
            {
                Raise(least, Math.Max(all, 1), shown < 0 ? 0 : finest);
            }
        }

        /// <summary>Fewer parts, then fewer splats; where all are at their coarsest, fewer parts than would do.</summary>
        private void Lower(int least, int shown)
        {
            patience = isRaised ? Math.Min(2 * patience, Patience) : patience;
            roomy = 0;
            isRaised = false;
            if (Parts > least)
            {
                Parts = Math.Max(Parts / 2, least);
            }
            else if (shown < 0 || (Splats >= 0 && Splats < shown))
            {
                Parts = Math.Max(Parts / 2, 1);
            }
            else
            {
                Splats = (int)(Step * shown);
            }
        }

        /// <summary>As many parts as will do, then more splats, as many as there are, then more parts.</summary>
        private void Raise(int least, int mostParts, int finest)
        {
            patience = isRaised ? Math.Max(patience / 2, 1) : patience;
            roomy = 0;
            isRaised = true;
            if (Parts < least)
            {
                Parts = Math.Min(2 * Parts, least);
            }
            else if (Splats >= 0)
            {
                int more = (int)(Splats / Step) + 1;
                Splats = more >= finest ? -1 : more;
            }
            else
            {
                Parts = Math.Min(2 * Parts, mostParts);
            }
        }
    }
}
