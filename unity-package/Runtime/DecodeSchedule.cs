using System.Collections.Generic;

namespace Mua
{
    /// <summary>
    /// Decides which part of which decode a displayed frame makes, so that its time does not grow with the number of avatars.
    /// One that is alone in view shows in time what is due: a clip's next pose is known, and decoded before. Several take
    /// turns, in rounds: first those never decoded, then those that have waited Longest, then the largest on screen whose pose
    /// changed most. As python/mua/avatar/decode_turns.py; tests hold both to it.
    /// </summary>
    internal sealed class DecodeSchedule
    {
        /// <summary>Parts in a displayed frame of an avatar that is alone in view: half of a decode.</summary>
        public const int Alone = 2;

        /// <summary>Displayed frames, a quarter of a second at 72 Hz.</summary>
        public const int Longest = 18;

        private DecodeTurn holder; // whose decode is being made
        private int round = 1;

        /// <summary>Sets the steps of one displayed frame; how many parts several avatars made in turns.</summary>
        /// <param name="turns">Avatars in view whose steps are not set yet, in an order that stays.</param>
        /// <param name="frame">The displayed frame's number.</param>
        /// <param name="parts">Parts in it where several avatars take turns.</param>
        /// <param name="alone">Whether no other avatar is in view.</param>
        public int Plan(List<DecodeTurn> turns, int frame, int parts, bool alone)
        {
            int taken = 0;
            for (int i = 0; i < turns.Count; i++)
            {
                DecodeTurn turn = turns[i];
                turn.Begin(frame);
                if (alone || !turn.Ask.Spreads)
                {
                    taken += turn.ShowDue();
                }
                else
                {
                    turn.ShowLate();
                }
            }
            if (!alone)
            {
                return Serve(turns, frame, parts);
            }
            holder = null;
            for (int i = 0; i < turns.Count && taken == 0; i++) // a frame that must complete what is due does no more
            {
                turns[i].LookAhead(Alone);
            }
            return 0;
        }

        /// <summary>Makes parts of one avatar's decode after the other's; none has two in one frame.</summary>
        private int Serve(List<DecodeTurn> turns, int frame, int parts)
        {
            int spare = parts;
            while (spare > 0)
            {
                if (holder == null || !turns.Contains(holder) || !holder.Ask.Spreads || holder.PartsLeft == 0)
                {
                    holder = Next(turns, frame);
                    if (holder == null)
                    {
                        break;
                    }
                    holder.TakeTurn(round, frame);
                }
                spare -= holder.Make(spare);
            }
            return parts - spare;
        }

        /// <summary>Whose turn it is, in this round or, once all that wait were served, in the next; null where none waits.</summary>
        private DecodeTurn Next(List<DecodeTurn> turns, int frame)
        {
            DecodeTurn first = FirstOfRound(turns, frame, out bool anyWaits);
            if (first == null && anyWaits)
            {
                round++;
                first = FirstOfRound(turns, frame, out anyWaits);
            }
            return first;
        }

        private DecodeTurn FirstOfRound(List<DecodeTurn> turns, int frame, out bool anyWaits)
        {
            DecodeTurn first = null;
            anyWaits = false;
            for (int i = 0; i < turns.Count; i++)
            {
                DecodeTurn turn = turns[i];
                if (!turn.Ask.Spreads || turn.IsServed || !turn.Waits)
                {
                    continue;
                }
                anyWaits = true;
                if (turn.Round != round && (first == null || IsBefore(turn, first, frame)))
                {
                    first = turn;
                }
            }
            return first;
        }

        private static bool IsBefore(DecodeTurn a, DecodeTurn b, int frame)
        {
            if (a.HasShown != b.HasShown)
            {
                return b.HasShown;
            }
            int waited = Overdue(a, frame), other = Overdue(b, frame);
            return waited != other ? waited > other : a.Ask.Rank > b.Ask.Rank;
        }

        private static int Overdue(DecodeTurn turn, int frame)
        {
            return frame - turn.Since >= Longest ? frame - turn.Since : 0;
        }
    }
}
