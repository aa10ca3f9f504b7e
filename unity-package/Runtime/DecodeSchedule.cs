using UnityEngine.Rendering;

namespace Mua
{
    /// <summary>
    /// Decides which part of which decode a displayed frame makes, so that none has to make all of it. The poses of a
    /// clip that come next are decoded part by part in the displayed frames before they are due; those of a rig are
    /// shown a displayed frame or two after they came. A pose that nobody saw coming, the first or one that was sought,
    /// is decoded at once. Another level of detail comes with the next decode, at rest at once. As
    /// python/mua/player/schedule.py.
    /// </summary>
    internal sealed class DecodeSchedule
    {
        private const long None = -1;
        private const int Levels = 16; // more than an avatar has

        private readonly AvatarFrame frame;
        private long shown = None; // the window's number and the level of detail
        private long coming = None; // begun, and not shown

        public DecodeSchedule(AvatarFrame frame)
        {
            this.frame = frame;
        }

        /// <summary>
        /// Shows the due decode where it is complete already; frames drawn without a Record use it from now on.
        /// </summary>
        public void ShowWhole(AvatarPose pose)
        {
            if (pose.Due == Window(coming) && frame.PartsLeft == 0)
            {
                Swap();
            }
        }

        /// <summary>
        /// Appends what one displayed frame decodes; whether other channels are shown than before. A frame that must complete
        /// what is due does no more. Where it spreads nothing, it decodes what is due at once.
        /// </summary>
        public bool Record(CommandBuffer commands, AvatarPose pose, int level, bool spreads)
        {
            long due = pose.Due * Levels + level, following = due;
            if (spreads && pose.MayLag && shown != None)
            {
                due = coming != None ? coming : shown;
            }
            else if (spreads && pose.Following != pose.Due)
            {
                due = Window(shown) == pose.Due ? shown : Window(coming) == pose.Due ? coming : due;
                following = pose.Following * Levels + level;
            }
            bool isOther = due != shown;
            int taken = isOther ? Show(commands, pose, due) : 0;
            if (following != shown && taken == 0)
            {
                LookAhead(commands, pose, following);
            }
            return isOther;
        }

        /// <summary>Shows what is due; how many parts that took.</summary>
        private int Show(CommandBuffer commands, AvatarPose pose, long due)
        {
            int taken = ChannelDecoder.Parts;
            if (due == coming)
            {
                taken = frame.PartsLeft;
                for (int i = 0; i < taken; i++)
                {
                    frame.Advance(commands);
                }
                Swap();
            }
            else
            {
                pose.ReadWindow(Window(due));
                frame.DecodeChannels(commands, pose.Window, pose.WindowTranslations, Level(due));
                shown = due;
                coming = None;
            }
            return taken;
        }

        private void LookAhead(CommandBuffer commands, AvatarPose pose, long following)
        {
            if (Window(following) != Window(coming))
            {
                pose.ReadWindow(Window(following));
                frame.Begin(pose.Window, pose.WindowTranslations, Level(following));
                coming = following;
            }
            if (frame.PartsLeft > 0)
            {
                frame.Advance(commands);
            }
        }

        private void Swap()
        {
            frame.Show();
            shown = coming;
            coming = None;
        }

        private static long Window(long decode)
        {
            return decode == None ? None : decode / Levels;
        }

        private static int Level(long decode)
        {
            return (int)(decode % Levels);
        }
    }
}
