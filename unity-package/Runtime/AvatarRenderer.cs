using System;
using System.Collections.Generic;
using UnityEngine;
using UnityEngine.Rendering;

namespace Mua
{
    /// <summary>
    /// Shows an avatar where its GameObject stands: one of its own clips, or the pose of transforms that something else
    /// moves. The character faces the GameObject's forward axis; scale is not supported.
    /// </summary>
    [ExecuteAlways, DisallowMultipleComponent, AddComponentMenu("MUA/Avatar"), DefaultExecutionOrder(1000)]
    public sealed class AvatarRenderer : MonoBehaviour
    {
        [SerializeField, Tooltip("An imported avatar.")]
        private AvatarAsset avatar = null;

        [SerializeField, Tooltip("In place of an imported avatar: a file in persistentDataPath or StreamingAssets.")]
        private string file = "";

        [SerializeField, Tooltip("Root of a rig whose transforms give the pose; without one, a clip of the avatar plays.")]
        private Transform rig = null;

        [SerializeField, Tooltip("Name of a clip of the avatar; the first where it is empty.")]
        private string clip = "";

        [SerializeField, Tooltip("Of the clip; 1 is as recorded.")]
        private float speed = 1;

        [SerializeField]
        private AvatarViews views = AvatarViews.Splats | AvatarViews.Shadow;

        private readonly AvatarMotion motion = new AvatarMotion();
        private readonly AvatarPlacement placement = new AvatarPlacement();
        private AvatarLoader loader;
        private AvatarBuffers buffers;
        private bool hasMoved; // since the last Record
        private bool isEdited; // the inspector has changed a field
        private AvatarAsset loaded; // as avatar, file and clip were when they took effect
        private string loadedFile = "";
        private string loadedClip = "";
        private bool isScaleReported;
        private string refusal; // why there is no room for the avatar beside the others

        /// <summary>The imported avatar that is shown; null where it came from a file.</summary>
        public AvatarAsset Avatar => avatar;

        public AvatarState State { get; private set; }

        /// <summary>Why there is nothing to see, or what is wrong with the pose; empty where all is well.</summary>
        public string Message { get; private set; } = "";

        /// <summary>Of loading, from 0 to 1.</summary>
        public float Progress => State == AvatarState.Ready ? 1 : loader == null ? 0 : loader.Progress;

        /// <summary>The file's name for the avatar; empty until it is ready.</summary>
        public string AvatarName => State == AvatarState.Ready ? buffers.Avatar.Name : "";

        /// <summary>Names of the avatar's clips.</summary>
        public IReadOnlyList<string> Clips => motion.Playback.Names;

        /// <summary>Index of the clip that plays.</summary>
        public int ClipIndex
        {
            get => motion.Playback.Index;
            set => motion.Playback.Index = value;
        }

        /// <summary>Whether the clip goes on by itself.</summary>
        public bool IsPlaying { get; set; } = true;

        /// <summary>Of the clip; 1 is as recorded.</summary>
        public float Speed
        {
            get => speed;
            set => speed = value;
        }

        /// <summary>Seconds into the clip.</summary>
        public double Seconds
        {
            get => motion.Playback.Seconds;
            set => motion.Playback.Seconds = value;
        }

        /// <summary>Frame of the clip at the avatar's rate; setting it goes to the frame's beginning.</summary>
        public int Frame
        {
            get => motion.Playback.Frame;
            set => motion.Playback.Frame = value;
        }

        /// <summary>Frames of the clip at the avatar's rate.</summary>
        public int FrameCount => motion.Playback.FrameCount;

        /// <summary>Transforms that give the pose, or null where a clip does.</summary>
        public Transform Rig
        {
            get => rig;
            set
            {
                rig = value;
                BindRig();
            }
        }

        public AvatarViews Views
        {
            get => views;
            set
            {
                views = value;
                AvatarWorld.Refresh();
            }
        }

        /// <summary>Box of the last pose in Unity's world, metres.</summary>
        public Bounds Bounds =>
            State == AvatarState.Ready
                ? AvatarSpace.Box(Decoded.Low, Decoded.High)
                : new Bounds(transform.position, Vector3.zero);

        /// <summary>The decoder; null until the avatar is ready.</summary>
        internal AvatarFrame Decoded { get; private set; }

        /// <summary>Its other views; null until the avatar is ready.</summary>
        internal AvatarSurface Surface { get; private set; }

        /// <summary>Whether it shows the file or the imported avatar of that name, without an ending.</summary>
        internal bool Shows(string stem)
        {
            return avatar != null ? avatar.name == stem : System.IO.Path.GetFileNameWithoutExtension(file) == stem;
        }

        /// <summary>Shows another imported avatar; the present one goes at once.</summary>
        public void Load(AvatarAsset asset)
        {
            avatar = asset;
            file = "";
            Reload();
        }

        /// <summary>Shows the avatar of a file: a full path, or one in persistentDataPath or StreamingAssets.</summary>
        public void Load(string path)
        {
            avatar = null;
            file = path;
            Reload();
        }

        /// <summary>Appends what has changed since the last call: a decode, another pose, or nothing.</summary>
        internal void Record(CommandBuffer commands)
        {
            AvatarPose pose = motion.Pose;
            if (pose.IsFresh)
            {
                Decoded.Decode(
                    commands, pose.Window, pose.WindowTranslations, pose.Current, pose.CurrentTranslations, placement.Value);
            }
            else if (hasMoved)
            {
                Decoded.Repose(commands, pose.Current, pose.CurrentTranslations, placement.Value);
            }
            pose.IsFresh = false;
            hasMoved = false;
        }

        /// <summary>Has the next Record pose the avatar again.</summary>
        internal void MarkMoved()
        {
            hasMoved = true;
        }

        /// <summary>Has the next Update end the avatar; nothing may go while a camera is drawn.</summary>
        internal void Refuse(string sentence)
        {
            refusal = sentence;
        }

        private void OnEnable()
        {
            Reload();
        }

        private void OnDisable()
        {
            Release();
            State = AvatarState.Empty;
        }

        private void OnValidate()
        {
            isEdited = isActiveAndEnabled; // nothing may be made or given back here
        }

        private void Update()
        {
            if (isEdited)
            {
                Revise();
            }
            if (refusal != null)
            {
                Fail(buffers.Avatar.Name + " beside the other avatars: " + refusal);
            }
            if (State == AvatarState.Loading)
            {
                ContinueLoading();
            }
        }

        private void LateUpdate()
        {
            if (State == AvatarState.Ready)
            {
                Place();
                Pose();
                Surface.CastShadow(views, Bounds, gameObject.layer);
            }
        }

        /// <summary>Has what the inspector changed take effect.</summary>
        private void Revise()
        {
            isEdited = false;
            if (avatar != loaded || file != loadedFile)
            {
                Reload();
            }
            else if (State == AvatarState.Ready)
            {
                Message = "";
                if (clip != loadedClip)
                {
                    ChooseClip();
                }
                BindRig();
                AvatarWorld.Refresh();
            }
        }

        private void Reload()
        {
            Release();
            isEdited = false;
            loaded = avatar;
            loadedFile = file;
            State = AvatarState.Empty;
            Message = "";
            if (!isActiveAndEnabled || (avatar == null && string.IsNullOrEmpty(file)))
            {
                return;
            }
            try
            {
                AvatarWorld.RequireResources();
            }
            catch (InvalidOperationException error)
            {
                Fail(error.Message);
                return;
            }
            loader = avatar != null ? AvatarLoader.Of(avatar) : AvatarLoader.Of(file);
            State = AvatarState.Loading;
            if (!Application.isPlaying)
            {
                ContinueLoading();
            }
        }

        private void ContinueLoading()
        {
            try
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
                Decoded = new AvatarFrame(AvatarWorld.RequireResources(), buffers);
                Surface = new AvatarSurface(AvatarWorld.RequireResources(), Decoded);
                Begin();
            }
            catch (Exception error) // whatever it is: the user sees one sentence, and no frame tries again
            {
                Fail(loader.Source + ": " + error.Message);
            }
        }

        /// <summary>Everything is on the device.</summary>
        private void Begin()
        {
            loader.Dispose();
            motion.Take(buffers.Avatar);
            ChooseClip();
            AvatarWorld.Add(this);
            loader = null;
            State = AvatarState.Ready;
            BindRig();
        }

        private void ChooseClip()
        {
            loadedClip = clip;
            if (!motion.Playback.Choose(clip) && !string.IsNullOrEmpty(clip))
            {
                Warn("the avatar has no clip " + clip + "; it has " + string.Join(", ", motion.Playback.Names) + ".");
            }
        }

        private void BindRig()
        {
            string fault = motion.Bind(rig);
            if (fault.Length > 0)
            {
                Warn(fault);
            }
        }

        /// <summary>Where the GameObject stands now.</summary>
        private void Place()
        {
            hasMoved |= placement.Follow(transform);
            if (!isScaleReported && !AvatarSpace.IsRigid(transform.lossyScale))
            {
                isScaleReported = true;
                Warn("the GameObject is scaled by " + transform.lossyScale + "; an avatar keeps its size in metres.");
            }
        }

        private void Pose()
        {
            if (motion.LosesRig())
            {
                Warn("the transforms of its pose were destroyed.");
            }
            hasMoved |= motion.Sample(Time.timeAsDouble, IsPlaying && Application.isPlaying ? Time.deltaTime * speed : 0);
        }

        private void Warn(string sentence)
        {
            Message = sentence;
            Debug.LogWarning("MUA: " + name + ": " + sentence, this);
        }

        private void Fail(string sentence)
        {
            Release();
            State = AvatarState.Failed;
            Message = sentence;
            AvatarWorld.Report(sentence, this);
        }

        /// <summary>Gives back what the avatar holds, however far it came.</summary>
        private void Release()
        {
            AvatarWorld.Remove(this);
            loader?.Dispose();
            Surface?.Dispose();
            Decoded?.Dispose();
            buffers?.Dispose();
            loader = null;
            Surface = null;
            Decoded = null;
            buffers = null;
            motion.Clear();
            placement.Forget();
            refusal = null;
        }
    }
}
