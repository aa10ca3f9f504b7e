using System;

namespace Mua
{
    /// <summary>An avatar in view in a displayed frame. Numbers tell the windows of poses apart.</summary>
    internal struct DecodeAsk
    {
        /// <summary>The window that the avatar is in.</summary>
        public long Due;

        /// <summary>The one to be decoded before it is due; Due where none is foreseen.</summary>
        public long Following;

        /// <summary>Level of detail.</summary>
        public int Level;

        /// <summary>Pixels of its height, times the radians by which its pose changed since the last decode.</summary>
        public double Rank;

        /// <summary>Whether its decode may be spread over displayed frames.</summary>
        public bool Spreads;

        /// <summary>Whether what is due may be shown a little later, where it is alone.</summary>
        public bool MayLag;
    }

    /// <summary>What a displayed frame does for an avatar, in this order.</summary>
    internal struct DecodeSteps
    {
        /// <summary>The decode to make at once and show, or DecodeTurn.None.</summary>
        public long Whole;

        /// <summary>Parts to complete before what was begun is shown.</summary>
        public int Finish;

        /// <summary>Whether to show what was begun.</summary>
        public bool Shows;

        /// <summary>The decode to begin, in place of one begun before, or DecodeTurn.None.</summary>
        public long Begin;

        /// <summary>Parts to make of what was begun.</summary>
        public int Parts;
    }

    /// <summary>The decodes of one avatar. A decode is a window's number and a level of detail in one.</summary>
    internal sealed class DecodeTurn
    {
        public const long None = -1;

        private const int Levels = 16; // more than an avatar has

        public DecodeAsk Ask;
        public DecodeSteps Steps;

        /// <summary>Parts missing from what was begun.</summary>
        public int PartsLeft;

        /// <summary>Displayed frame in which it began to wait; negative before it is first asked for.</summary>
        public int Since = -1;

        /// <summary>Round in which it last had a turn.</summary>
        public int Round;

        /// <summary>Whether a decode was completed in this displayed frame.</summary>
        public bool IsServed;

        private long shown = None, coming = None; // the second is begun, and not shown

        public bool HasShown => shown != None;

        /// <summary>Whether another decode is wanted than the one shown, and is not complete either.</summary>
        public bool Waits => shown != Wanted && !(PartsLeft == 0 && IsComing(Ask.Following));

        private long Wanted => Ask.Following * Levels + Ask.Level;

        public static long Window(long decode)
        {
            return decode == None ? None : decode / Levels;
        }

        public static int Level(long decode)
        {
            return (int)(decode % Levels);
        }

        /// <summary>Whether what was begun is whole and due, and is shown from now on.</summary>
        public bool ShowWhole(long due)
        {
            bool isWhole = PartsLeft == 0 && IsComing(due);
            shown = isWhole ? coming : shown;
            coming = isWhole ? None : coming;
            return isWhole;
        }

        /// <summary>Takes no steps as yet.</summary>
        public void Begin(int frame)
        {
            Steps = new DecodeSteps { Whole = None, Begin = None };
            IsServed = false;
            Since = Since < 0 || !Waits ? frame : Since;
        }

        /// <summary>Shows what is due whatever that takes; how many parts it took.</summary>
        public int ShowDue()
        {
            long wanted = Ask.Due * Levels + Ask.Level;
            if (Ask.Spreads && Ask.MayLag && HasShown)
            {
                wanted = coming != None ? coming : shown;
            }
            else if (Ask.Spreads && Ask.Following != Ask.Due) // another level comes with the next decode
            {
                wanted = Window(shown) == Ask.Due ? shown : IsComing(Ask.Due) ? coming : wanted;
            }
            if (wanted == shown)
            {
                return 0;
            }
            int taken = ChannelDecoder.Parts;
            if (wanted == coming)
            {
                taken = Steps.Finish = PartsLeft;
                Steps.Shows = true;
            }
            else
            {
                Steps.Whole = wanted;
            }
            shown = wanted;
            coming = None;
            PartsLeft = 0;
            return taken;
        }

        /// <summary>Shows what is complete, unless it is still to come or what is due is shown already.</summary>
        public void ShowLate()
        {
            bool isLate = !IsComing(Ask.Following) && Window(shown) != Ask.Due;
            if (coming != None && PartsLeft == 0 && (IsComing(Ask.Due) || isLate))
            {
                Steps.Shows = true;
                shown = coming;
                coming = None;
            }
        }

        /// <summary>Makes so many parts of what is to come, where it is not shown already.</summary>
        public void LookAhead(int parts)
        {
            if (!Ask.Spreads || shown == Wanted)
            {
                return;
            }
            if (!IsComing(Ask.Following))
            {
                BeginWanted();
            }
            Make(parts);
        }

        /// <summary>Takes a turn: goes on with what was begun where that is still wanted, else begins anew.</summary>
        public void TakeTurn(int round, int frame)
        {
            Round = round;
            Since = frame;
            if (PartsLeft == 0 || !IsComing(Ask.Following))
            {
                BeginWanted();
            }
        }

        /// <summary>Makes parts of what was begun; how many there were.</summary>
        public int Make(int most)
        {
            int made = Math.Min(most, PartsLeft);
            PartsLeft -= made;
            Steps.Parts += made;
            IsServed = PartsLeft == 0;
            return made;
        }

        private void BeginWanted()
        {
            coming = Steps.Begin = Wanted;
            PartsLeft = ChannelDecoder.Parts;
        }

        private bool IsComing(long window)
        {
            return coming != None && Window(coming) == window;
        }
    }
}
