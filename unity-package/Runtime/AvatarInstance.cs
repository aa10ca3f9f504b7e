using System;
using UnityEngine;
using UnityEngine.Rendering;

namespace Mua
{
    /// <summary>
    /// One avatar from its file to its end: brought to the device, moved in every frame, and decoded and posed whenever a
    /// camera draws it. The AvatarRenderer that made it says where it stands, what moves it and which views are drawn.
    /// </summary>
    internal sealed class AvatarInstance : IDisposable
    {
        private readonly AvatarRenderer owner;
        private readonly AvatarPlacement placement = new AvatarPlacement();
        private readonly AvatarResources resources;
        private AvatarLoader loader; // null once everything is on the device
        private AvatarBuffers buffers;
        private AvatarMotion motion;
        private string chosen = ""; // the clip's name when it took effect
        private string refusal; // why there is no room beside the other avatars
        private bool hasMoved; // since the last Record
        private bool isDue; // Move was called since the last Ask
        private bool isMissed; // frames went by without an Ask
        private bool spreads; // a decode over displayed frames
        private bool isScaleReported, isLevelReported;
        private int level;

        /// <summary>Begins to load what `open` opens.</summary>
        public AvatarInstance(AvatarRenderer owner, Func<AvatarLoader> open)
        {
            this.owner = owner;
            try
            {
                resources = AvatarResources.Require();
                loader = open();
                State = AvatarState.Loading;
            }
            catch (Exception error) when (error is InvalidOperationException || error is ArgumentException) // the latter of paths
            {
                Fail(error.Message);
            }
        }

        public AvatarState State { get; private set; }

        /// <summary>Why it has failed, or what is wrong with the pose; empty where all is well.</summary>
        public string Message { get; private set; } = "";

        /// <summary>Progress of loading, from 0 to 1.</summary>
        public float Progress => State == AvatarState.Ready ? 1 : loader == null ? 0 : loader.Progress;

        /// <summary>The file's name for the avatar; empty until it is ready.</summary>
        public string Name => State == AvatarState.Ready ? buffers.Avatar.Name : "";

        /// <summary>Its clips; none until it is ready.</summary>
        public AvatarPlayback Playback => State == AvatarState.Ready ? motion.Playback : AvatarPlayback.None;

        /// <summary>Weights of its expressions that were set; none until it is ready.</summary>
        public AvatarExpressions Expressions => State == AvatarState.Ready ? motion.Pose.Expressions : AvatarExpressions.None;

        /// <summary>The decoder; null until it is ready.</summary>
        public AvatarFrame Decoded { get; private set; }

        /// <summary>Which decodes there are, and what the displayed frame does for them.</summary>
        public DecodeTurn Turn { get; } = new DecodeTurn();

        /// <summary>Whether it is not known yet what this displayed frame decodes.</summary>
        public bool IsDue => isDue || !spreads;

        /// <summary>Its views other than splats; null until it is ready.</summary>
        public AvatarSurface Surface { get; private set; }

        /// <summary>Which cameras it is drawn for; null until it is ready.</summary>
        public AvatarSight Sight { get; private set; }

        public AvatarViews Views => owner.Views;

        /// <summary>Level of detail for the next Record.</summary>
        public int Level
        {
            get => ChoosesLevel ? level : FixedLevel;
            set => level = value;
        }

        /// <summary>Whether distance and budget choose the level; the detailed geometry is of the finest.</summary>
        public bool ChoosesLevel =>
            owner.Level == AvatarLevel.Automatic && (Views & AvatarViews.Splats) != 0 && (Views & AvatarViews.Geometry) == 0;

        /// <summary>Box of the last pose in Unity's world, metres; empty until it is ready.</summary>
        public Bounds Bounds =>
            State == AvatarState.Ready
                ? AvatarSpace.Box(Decoded.Low, Decoded.High)
                : new Bounds(owner.transform.position, Vector3.zero);

        /// <summary>Loads a frame's share; in an editor that does not play, all of it.</summary>
        public void Update()
        {
            if (refusal != null)
            {
                Fail(Name + " does not fit beside the other avatars: " + refusal);
            }
            if (State != AvatarState.Loading)
            {
                return;
            }
            string source = loader.Source; // the loader goes before the rig is bound
            try
            {
                Continue();
            }
            catch (Exception error) // whatever it is: the user sees one sentence, and no frame tries again
            {
                Fail(source + ": " + error.Message);
            }
        }

        /// <summary>
        /// Moves to the GameObject's place, advances the clip by so many seconds, and casts the shadow.
        /// </summary>
        public void Move(double step)
        {
            if (State != AvatarState.Ready)
            {
                return;
            }
            hasMoved |= placement.Follow(owner.transform);
            if (!isScaleReported && !AvatarPlace.IsUniform(owner.transform.lossyScale))
            {
                isScaleReported = true;
                Warn(
                    "the GameObject has the scale " + owner.transform.lossyScale
                    + ", but avatars follow only one scale for all axes, which is not negative; it is shown at scale 1.");
            }
            if (motion.LosesRig())
            {
                Warn("the rig that posed the avatar was destroyed; a clip plays in its place.");
            }
            if (motion.LosesFace())
            {
                Warn("the mesh whose blend shapes moved the avatar's face was destroyed; its clip moves it in their place.");
            }
            hasMoved |= motion.Sample(Time.timeAsDouble, step);
            motion.Express(Time.realtimeSinceStartupAsDouble, !Application.isPlaying); // a face moves while the game is paused
            Decoded.Stand(motion.Pose.Current, motion.Pose.CurrentTranslations, placement.Value);
            spreads = owner.SpreadDecode && Application.isPlaying
                && (Views & AvatarViews.Geometry) == 0; // which is of the finest level
            isMissed = isDue;
            isDue = true;
            if (Turn.ShowWhole(motion.Pose.Due)) // frames drawn without a Record use it from now on
            {
                Decoded.Show();
            }
            Surface.CastShadow(Views, Bounds, owner.gameObject);
        }

        /// <summary>Asks for the decodes of this displayed frame.</summary>
        public void Ask(AvatarEyes eyes, bool alone)
        {
            AvatarPose pose = motion.Pose;
            Turn.Ask = new DecodeAsk
            {
                Due = pose.Due,
                Following = pose.Following,
                Level = Level,
                Rank = alone ? 0 : Sight.Seen(eyes).Height * pose.Turned,
                Spreads = spreads && !(alone && isMissed),
                MayLag = pose.MayLag,
            };
            isDue = false;
        }

        /// <summary>Appends what Turn says.</summary>
        public void Decode(CommandBuffer commands)
        {
            DecodeSteps steps = Turn.Steps;
            if (steps.Whole != DecodeTurn.None)
            {
                AvatarPose pose = Window(steps.Whole);
                Decoded.DecodeChannels(
                    commands, pose.Window, pose.WindowTranslations, pose.Weights, DecodeTurn.Level(steps.Whole));
            }
            Advance(commands, steps.Finish);
            if (steps.Shows)
            {
                Decoded.Show();
            }
            if (steps.Begin != DecodeTurn.None)
            {
                AvatarPose pose = Window(steps.Begin);
                Decoded.Begin(pose.Window, pose.WindowTranslations, pose.Weights, DecodeTurn.Level(steps.Begin));
            }
            Advance(commands, steps.Parts);
            hasMoved |= steps.Shows || steps.Whole != DecodeTurn.None;
        }

        /// <summary>Appends what brings it to its pose, where that has changed since the last call.</summary>
        public void Record(CommandBuffer commands)
        {
            if (hasMoved)
            {
                Decoded.Repose(commands, motion.Pose.Current, motion.Pose.CurrentTranslations, placement.Value);
            }
            hasMoved = false;
        }

        /// <summary>Makes the next Record pose the avatar again.</summary>
        public void MarkMoved()
        {
            hasMoved = true;
        }

        /// <summary>Makes the next Update end the avatar: nothing may be released while a camera draws.</summary>
        public void Refuse(string sentence)
        {
            refusal = sentence;
        }

        /// <summary>Applies what the inspector changed.</summary>
        public void Revise()
        {
            if (State == AvatarState.Ready)
            {
                Message = "";
                if (owner.Clip != chosen)
                {
                    ChooseClip();
                }
                BindRig();
                BindFace();
                CheckLevel();
            }
        }

        /// <summary>The weight of an expression at this moment, by its place among the names.</summary>
        public float Weight(int expression)
        {
            return motion.Pose.Weight(expression);
        }

        /// <summary>Takes the blend shapes of the owner's Face, where there is one.</summary>
        public void BindFace()
        {
            string fault = State == AvatarState.Ready ? motion.Bind(owner.Face) : "";
            if (fault.Length > 0)
            {
                Warn(fault);
            }
        }

        /// <summary>Takes the transforms below the owner's Rig, or the clip where there is none.</summary>
        public void BindRig()
        {
            string fault = State == AvatarState.Ready ? motion.Bind(owner.Rig) : "";
            if (fault.Length > 0)
            {
                Warn(fault);
            }
        }

        /// <summary>Releases everything, however far loading came.</summary>
        public void Dispose()
        {
            State = AvatarState.Empty;
            AvatarWorld.Remove(this);
            loader?.Dispose();
            Surface?.Dispose();
            Decoded?.Dispose();
            buffers?.Dispose();
            loader = null;
            Surface = null;
            Sight = null;
            Decoded = null;
            buffers = null;
            motion = null;
            refusal = null;
        }

        private void Continue()
        {
            if (!Application.isPlaying)
            {
                loader.Finish();
            }
            else if (!loader.Continue())
            {
                return;
            }
            buffers = loader.Take();
            Decoded = new AvatarFrame(resources, buffers);
            Surface = new AvatarSurface(resources, Decoded);
            Sight = new AvatarSight(owner, Decoded, buffers);
            motion = new AvatarMotion(buffers.Avatar);
            AvatarWorld.Add(this, resources);
            loader.Dispose();
            loader = null;
            State = AvatarState.Ready;
            ChooseClip();
            BindRig();
            BindFace();
            CheckLevel();
        }

        /// <summary>The pose with the window of a decode, which it takes note of.</summary>
        private AvatarPose Window(long decode)
        {
            motion.Pose.ReadWindow(DecodeTurn.Window(decode));
            motion.Pose.MarkDecoded();
            return motion.Pose;
        }

        private void Advance(CommandBuffer commands, int parts)
        {
            for (int i = 0; i < parts; i++)
            {
                Decoded.Advance(commands);
            }
        }

        /// <summary>The level that the owner asks for, where distance does not choose; the finest where there is none.</summary>
        private int FixedLevel
        {
            get
            {
                int asked = (Views & AvatarViews.Geometry) != 0 ? 0 : Math.Max((int)owner.Level - (int)AvatarLevel.Full, 0);
                return asked < buffers.Levels.Length ? asked : 0;
            }
        }

        /// <summary>Says once where the avatar lacks the level that is asked for, or any to choose from.</summary>
        private void CheckLevel()
        {
            int asked = (int)owner.Level - (int)AvatarLevel.Full, most = buffers.Levels.Length;
            if (isLevelReported || (owner.Level == AvatarLevel.Automatic ? most > 1 : asked < most))
            {
                return;
            }
            isLevelReported = true;
            Warn("the avatar has no such level of detail; it is shown at full size.");
        }

        private void ChooseClip()
        {
            chosen = owner.Clip;
            if (!Playback.Choose(chosen) && !string.IsNullOrEmpty(chosen))
            {
                Warn("the avatar has no clip " + chosen + "; its clips are " + string.Join(", ", Playback.Names) + ".");
            }
        }

        private void Warn(string sentence)
        {
            Message = sentence;
            Debug.LogWarning("MUA: " + owner.name + ": " + sentence, owner);
        }

        private void Fail(string sentence)
        {
            Dispose();
            State = AvatarState.Failed;
            Message = sentence;
            if (SystemInfo.graphicsDeviceType != GraphicsDeviceType.Null) // a server asked for none
            {
                AvatarWorld.Report(sentence, owner);
            }
        }
    }
}
