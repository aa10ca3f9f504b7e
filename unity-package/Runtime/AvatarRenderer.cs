using System;
using System.Collections.Generic;
using UnityEngine;

namespace Mua
{
    /// <summary>
    /// Shows an avatar where its GameObject stands: one of its own clips, or the pose of transforms that something else
    /// moves. The character faces the GameObject's forward axis, and follows a scale that is the same along all axes.
    /// </summary>
    [ExecuteAlways, DisallowMultipleComponent, AddComponentMenu("MUA/Avatar"), DefaultExecutionOrder(1000)]
    public sealed class AvatarRenderer : MonoBehaviour
    {
        [SerializeField, Tooltip("The imported avatar to show.")]
        private AvatarAsset avatar = null;

        [SerializeField]
        [Tooltip("If Avatar is empty, a .muaavatar file: a full path, or one in persistentDataPath or StreamingAssets.")]
        private string file = "";

        [SerializeField, Tooltip("Root of a rig whose transforms pose the avatar; if empty, a clip of the avatar plays.")]
        private Transform rig = null;

        [SerializeField]
        [Tooltip("A mesh whose blend shapes set the avatar's expressions of equal or like names, as a face tracker moves them.")]
        private SkinnedMeshRenderer face = null;

        [SerializeField, Tooltip("Name of the clip to play; if empty, the first.")]
        private string clip = "";

        [SerializeField, Tooltip("Whether the clip plays by itself; if not, it stays at Time.")]
        private bool playing = true;

        [SerializeField, Tooltip("Seconds into the clip at which it begins; an animation of this field moves the avatar through its clip.")]
        private float time = 0;

        [SerializeField, Tooltip("Playback speed; 1 plays the clip at its recorded speed.")]
        private float speed = 1;

        [SerializeField, Tooltip("What is drawn: splats, their surface as geometry, the template (the coarse mesh), its bones, its shadow.")]
        private AvatarViews views = AvatarViews.Splats | AvatarViews.Shadow;

        [SerializeField]
        [Tooltip("Level of detail: how many texels are shown. Automatic shows fewer when the avatar is seen from afar.")]
        private AvatarLevel level = AvatarLevel.Automatic;

        [SerializeField]
        [Tooltip("Spread decodes over displayed frames, in turns with other avatars in view, so that no single frame takes long.")]
        private bool spreadDecode = true;

        private AvatarInstance shown; // null while there is nothing to show
        private AvatarAsset loaded; // as avatar and file were when they took effect
        private string loadedFile = "";
        private bool isEdited; // the inspector has changed a field
        private bool isBegun; // the clip, at Time
        private float shownTime; // Time when it took effect

        /// <summary>The avatar that is shown, imported or made of bytes; null where it came from a file.</summary>
        public AvatarAsset Avatar => avatar;

        public AvatarState State => shown == null ? AvatarState.Empty : shown.State;

        /// <summary>Why there is nothing to see, or what is wrong with the pose; empty where all is well.</summary>
        public string Message => shown == null ? "" : shown.Message;

        /// <summary>How much is loaded, from 0 to 1.</summary>
        public float Progress => shown == null ? 0 : shown.Progress;

        /// <summary>Name that the file gives the avatar; empty until it is ready.</summary>
        public string AvatarName => shown == null ? "" : shown.Name;

        /// <summary>Names of the avatar's clips.</summary>
        public IReadOnlyList<string> Clips => Playback.Names;

        /// <summary>Index of the clip that plays.</summary>
        public int ClipIndex
        {
            get => Playback.Index;
            set => Playback.Index = value;
        }

        /// <summary>Whether the clip plays; if not, it stays at Seconds.</summary>
        public bool IsPlaying
        {
            get => playing;
            set => playing = value;
        }

        /// <summary>Playback speed; 1 plays at the recorded speed.</summary>
        public float Speed
        {
            get => speed;
            set => speed = value;
        }

        /// <summary>Seconds into the clip.</summary>
        public double Seconds
        {
            get => Playback.Seconds;
            set => Playback.Seconds = value;
        }

        /// <summary>Frame of the clip at the avatar's rate; setting it goes to the frame's beginning.</summary>
        public int Frame
        {
            get => Playback.Frame;
            set => Playback.Frame = value;
        }

        /// <summary>Frames of the clip at the avatar's rate.</summary>
        public int FrameCount => Playback.FrameCount;

        /// <summary>Root of a rig whose transforms pose the avatar; null if a clip does.</summary>
        public Transform Rig
        {
            get => rig;
            set
            {
                rig = value;
                shown?.BindRig();
            }
        }

        /// <summary>
        /// A mesh whose blend shapes, of weights 0 to 100, set the avatar's expressions: those of equal names, whatever their
        /// case and underscores, else the nearest. Null if the clip and SetExpression do.
        /// </summary>
        public SkinnedMeshRenderer Face
        {
            get => face;
            set
            {
                face = value;
                shown?.BindFace();
            }
        }

        /// <summary>Names of the avatar's expressions, as in its file; none until it is ready.</summary>
        public IReadOnlyList<string> ExpressionNames => Expressions.Names;

        /// <summary>What is drawn of the avatar.</summary>
        public AvatarViews Views
        {
            get => views;
            set
            {
                views = value;
                AvatarWorld.Refresh();
            }
        }

        /// <summary>How many texels are shown.</summary>
        public AvatarLevel Level
        {
            get => level;
            set => level = value;
        }

        /// <summary>Splats of the level that is shown; 0 until the avatar is ready.</summary>
        public int SplatCount => shown == null || shown.Decoded == null ? 0 : shown.Decoded.SplatCount;

        /// <summary>
        /// Whether decodes are spread over displayed frames: in turns with other avatars in view, or, for one that is alone,
        /// where the display is faster than the avatar.
        /// </summary>
        public bool SpreadDecode
        {
            get => spreadDecode;
            set => spreadDecode = value;
        }

        /// <summary>
        /// Share of the pose that training did not show, from 0 to 1, of the pose decoded last; 0 until the avatar is
        /// ready. Poses outside are limited to the range of training, so that the avatar stays intact but follows less
        /// exactly.
        /// </summary>
        public float OutsideTraining => shown == null || shown.Decoded == null ? 0 : (float)shown.Decoded.Outside;

        /// <summary>Box of the last pose in Unity's world, metres.</summary>
        public Bounds Bounds =>
            shown == null ? new Bounds(transform.position, Vector3.zero) : shown.Bounds;

        /// <summary>The decoder; null until the avatar is ready.</summary>
        internal AvatarFrame Decoded => shown?.Decoded;

        /// <summary>Name of the clip to begin with, as the inspector has it.</summary>
        internal string Clip => clip;

        /// <summary>Its clips; none until the avatar is ready.</summary>
        internal AvatarPlayback Playback => shown == null ? AvatarPlayback.None : shown.Playback;

        private AvatarExpressions Expressions => shown == null ? AvatarExpressions.None : shown.Expressions;

        /// <summary>All AvatarRenderers in the open scenes, in no order; those of inactive GameObjects too where asked for.</summary>
        internal static AvatarRenderer[] All(FindObjectsInactive inactive = FindObjectsInactive.Exclude)
        {
#if UNITY_6000_4_OR_NEWER // where the one below is deprecated
            return FindObjectsByType<AvatarRenderer>(inactive);
#else
            return FindObjectsByType<AvatarRenderer>(inactive, FindObjectsSortMode.None);
#endif
        }

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

        /// <summary>
        /// Shows the avatar of a file's bytes, from a download, a stream or a TextAsset; they must not be changed while the
        /// component or a clone of it has them, and are not saved in the scene. Messages call the avatar `name`.
        /// </summary>
        public void Load(byte[] content, string name = "an avatar in memory")
        {
            Load(content == null ? null : AvatarAsset.CreateTemporary(content, name));
        }

        /// <summary>
        /// Sets how far an expression shows, held to 0 to 1, whatever else moves the avatar: one of its own, or one of ARKit,
        /// VRM or Oculus' visemes, which moves the nearest that it has. Whether any follows; none does until the avatar is
        /// ready. Another avatar begins without. ArgumentException where the weight is no finite number.
        /// </summary>
        public bool SetExpression(string name, float weight)
        {
            if (float.IsNaN(weight) || float.IsInfinity(weight))
            {
                throw new ArgumentException(
                    "the weight of the expression " + name + " is " + weight + ", expected a finite number", nameof(weight));
            }
            return Expressions.Set(name, weight);
        }

        /// <summary>
        /// The weight of one of its own expressions at this moment, 0 to 1, as it was set or as the clip has it, whatever else
        /// holds it back; 0 where it has none of this name.
        /// </summary>
        public float GetExpression(string name)
        {
            int index = Expressions.Find(name);
            return index < 0 ? 0 : shown.Weight(index);
        }

        /// <summary>Gives all expressions that were set back to the clip.</summary>
        public void ResetExpressions()
        {
            Expressions.Reset();
        }

        private void OnEnable()
        {
            Reload();
        }

        private void OnDisable()
        {
            Release();
        }

        private void OnDestroy()
        {
            Forget(avatar);
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
            Advance();
        }

        /// <summary>The engine calls it after an animation has changed fields.</summary>
        private void OnDidApplyAnimationProperties()
        {
            TakeTime();
        }

        private void LateUpdate()
        {
            shown?.Move(playing && Application.isPlaying ? Time.deltaTime * speed : 0);
        }

        /// <summary>Applies what the inspector changed.</summary>
        private void Revise()
        {
            isEdited = false;
            if (avatar != loaded || file != loadedFile)
            {
                Reload();
            }
            else
            {
                shown?.Revise();
                TakeTime();
                AvatarWorld.Refresh();
            }
        }

        /// <summary>Loads on; a clip that is there begins at Time.</summary>
        private void Advance()
        {
            shown?.Update();
            if (!isBegun && State == AvatarState.Ready)
            {
                isBegun = true;
                shownTime = 0;
                TakeTime();
            }
        }

        /// <summary>Goes to Time where that has changed.</summary>
        private void TakeTime()
        {
            if (isBegun && time != shownTime)
            {
                shownTime = time;
                Playback.Seconds = time;
            }
        }

        private void Reload()
        {
            Release();
            isEdited = false;
            if (loaded != avatar)
            {
                Forget(loaded);
            }
            loaded = avatar;
            loadedFile = file;
            if (!isActiveAndEnabled || (avatar == null && string.IsNullOrEmpty(file)))
            {
                return;
            }
            shown = new AvatarInstance(this, Open);
            isBegun = false;
            if (!Application.isPlaying)
            {
                Advance();
            }
        }

        private AvatarLoader Open()
        {
            return avatar != null ? AvatarLoader.Of(avatar) : AvatarLoader.Of(file);
        }

        /// <summary>Destroys an asset that was made of bytes, unless another component, such as a clone of this, has it.</summary>
        private void Forget(AvatarAsset asset)
        {
            if (asset != null && asset.IsTemporary
                && !Array.Exists(All(FindObjectsInactive.Include), other => other != this && other.avatar == asset))
            {
                DestroyImmediate(asset);
            }
        }

        private void Release()
        {
            shown?.Dispose();
            shown = null;
        }
    }
}
