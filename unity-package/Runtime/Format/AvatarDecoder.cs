using System;

namespace Mua.Format
{
    /// <summary>
    /// Builds an AvatarFile from its parsed tree and checks every shape, range and value, in the order of
    /// python/mua/asset/read.py: the same bad file gives the same code and field in both readers.
    /// </summary>
    internal sealed class AvatarDecoder
    {
        private const long Any = Tensors.Any;

        private static readonly byte[] PngSignature = { 0x89, (byte)'P', (byte)'N', (byte)'G', 0x0D, 0x0A, 0x1A, 0x0A };

        private readonly byte[] content;
        private readonly Tensors tensors;

        public AvatarDecoder(byte[] content)
        {
            this.content = content;
            tensors = new Tensors(content);
        }

        public AvatarFile Decode(Table tree)
        {
            var rig = new RigDecoder(tensors);
            var model = new ModelDecoder(tensors, content);
            var avatar = new AvatarFile { Content = content };
            avatar.Name = tree.Text("name");
            avatar.Producer = tree.Text("producer");
            avatar.Notes = tree.Text("notes");
            avatar.Skeleton = rig.Skeleton(tree.Child("skeleton"));
            avatar.Encoding = Encoding(tree.Child("encoding"), avatar.Skeleton, rig);
            avatar.Wavelet = model.Wavelet(tree.Child("wavelet"));
            int inputs = avatar.Encoding.ComponentCount, levels = avatar.Wavelet.Levels;
            avatar.Coarse = model.Coarse(tree.Child("coarse"), inputs);
            int vertices = avatar.Coarse.Mean.Shape[0];
            avatar.Template = rig.Template(tree.Child("template"), vertices, avatar.Skeleton.JointCount);
            avatar.Texels = rig.Texels(tree.Child("texels"), content, avatar.Template);
            int size = avatar.Texels.Size, count = avatar.Texels.Count, side = size >> levels;
            avatar.Geometry = model.Geometry(tree.Child("geometry"), count, inputs, side);
            avatar.Appearance = model.Appearance(tree.Child("appearance"), count, inputs, side);
            Magnitude.Require(avatar);
            avatar.Expressions = ExpressionDecoder.Expressions(tree.Child("expressions"), vertices, tensors);
            avatar.Clips = Clips(tree.Children("clips"), avatar.Skeleton, avatar.ExpressionCount, avatar.Encoding.Rate);
            avatar.Bounds = Bounds(tree.Child("bounds"));
            avatar.Thumbnail = Thumbnail(tree.Block("thumbnail"));
            avatar.Surface = rig.Surface(tree.Child("surface"), content, avatar.Texels);
            return avatar;
        }

        private PoseEncoding Encoding(Table tree, Skeleton skeleton, RigDecoder rig)
        {
            Tensor joints = tensors.Indices(tree.Child("joints"), "encoding.joints", 0, skeleton.JointCount, Any);
            var encoding = new PoseEncoding { Joints = joints.Integers.ToArray() };
            RigDecoder.RequireBesideRoot(encoding.Joints, "encoding.joints", skeleton.Root);
            encoding.Translated = rig.Translated(tree, "encoding.translated", skeleton);
            foreach (int joint in encoding.Translated)
            {
                if (Array.BinarySearch(skeleton.Translated, joint) < 0)
                {
                    throw Refusal.Of("encoding.translated", "joints must be among the skeleton's translated ones");
                }
            }
            long window = tree.Number("window");
            if (window < 1 || window > Limits.MaxWindow)
            {
                throw Refusal.Of("encoding.window", "{0} frames, expected 1 to {1}", window, Limits.MaxWindow);
            }
            encoding.Window = (int)window;
            encoding.Rate = Rate(tree, "encoding.rate");
            encoding.Heading = tree.Number("heading") != 0;
            ReadComponents(encoding, tree);
            return encoding;
        }

        /// <summary>Normalisation, principal components and their bounds.</summary>
        private void ReadComponents(PoseEncoding encoding, Table tree)
        {
            encoding.Scale = tensors.Reals(tree.Child("scale"), "encoding.scale", encoding.Width).ToFloats();
            foreach (float scale in encoding.Scale)
            {
                if (scale < (float)Limits.LeastScale)
                {
                    throw Refusal.Of("encoding.scale", "{0}, expected {1} or more", scale, Limits.LeastScale);
                }
            }
            encoding.Components = tensors.Reals(
                tree.Child("components"), "encoding.components", Any, encoding.Width);
            Tensors.RequireSome(encoding.Components, 0, "encoding.components");
            int count = encoding.Components.Shape[0];
            encoding.Ranges = tensors.Reals(tree.Child("ranges"), "encoding.ranges", 2, count).ToFloats();
            for (int i = 0; i < count; i++)
            {
                if (encoding.Ranges[i] > encoding.Ranges[count + i])
                {
                    throw Refusal.Of(
                        "encoding.ranges", "the lowest value of component {0} is above its highest", i);
                }
            }
            encoding.Margins = tensors.Reals(tree.Child("margins"), "encoding.margins", count).ToFloats();
            foreach (float margin in encoding.Margins)
            {
                if (margin < 0)
                {
                    throw Refusal.Of("encoding.margins", "{0}, expected 0 or more", margin);
                }
            }
            encoding.Mean = tensors.Reals(tree.Child("mean"), "encoding.mean", encoding.Width).ToFloats();
        }

        private static float Rate(Table tree, string path)
        {
            float rate = tree.Real("rate");
            if (!(rate >= Limits.LeastRate && rate <= Limits.LargestRate))
            {
                throw Refusal.Of(path, "{0} frames per second, expected {1} to {2}", rate, Limits.LeastRate, Limits.LargestRate);
            }
            return rate;
        }

        private Clip[] Clips(Table[] tree, Skeleton skeleton, int expressions, double encodingRate)
        {
            var clips = new Clip[tree.Length];
            double added = 0;
            for (int i = 0; i < clips.Length; i++)
            {
                clips[i] = Clip(tree[i], "clips[" + i + "]", skeleton, expressions);
                int frames = clips[i].FrameCount;
                double times = Math.Max(encodingRate / clips[i].Rate, 1);
                added += (times - 1) * frames * (skeleton.JointCount + (clips[i].Expressions == null ? 0 : expressions));
                if (times * frames > Limits.MaxFrames || added > Limits.MaxAdded)
                {
                    throw Refusal.Of(
                        "clips[" + i + "].rotations",
                        "{0} frames at a rate of {1}, too many for the encoding's rate of {2}", frames, clips[i].Rate,
                        encodingRate);
                }
            }
            return clips;
        }

        private Clip Clip(Table tree, string path, Skeleton skeleton, int expressions)
        {
            int joints = skeleton.JointCount;
            Tensor rotations = tensors.Reals(tree.Child("rotations"), path + ".rotations", Any, joints, 4);
            RigDecoder.RequireUnit(rotations, path + ".rotations");
            if (rotations.Shape[0] == 0)
            {
                throw Refusal.Of(path + ".rotations", "a clip needs at least one frame");
            }
            Tensor translation = tensors.Reals(
                tree.Child("translation"), path + ".translation", rotations.Shape[0], 3);
            Tensor translations = Translations(
                tree, path + ".translations", rotations.Shape[0], skeleton.Translated.Length);
            float rate = Rate(tree, path + ".rate");
            return new Clip
            {
                Translations = translations,
                Name = tree.Text("name"),
                Rate = rate,
                Rotations = rotations,
                Translation = translation,
                Expressions = ExpressionDecoder.Weights(
                    tree.Child("expressions"), path + ".expressions", rotations.Shape[0], expressions, tensors),
            };
        }

        private Tensor Translations(Table tree, string path, int frames, int joints)
        {
            Table stored = tree.Child("translations");
            if (stored == null && joints > 0)
            {
                throw new AvatarFormatException(
                    "missing", path, "absent, but the skeleton names " + joints + " translated joints");
            }
            return stored == null ? null : tensors.Reals(stored, path, frames, joints, 3);
        }

        private float[] Bounds(Table tree)
        {
            float[] bounds = tensors.Reals(tree, "bounds", 2, 3).ToFloats();
            for (int axis = 0; axis < 3; axis++)
            {
                if (bounds[axis] > bounds[3 + axis])
                {
                    throw Refusal.Of(
                        "bounds", "lowest corner {0} above highest {1} along axis {2}", bounds[axis], bounds[3 + axis],
                        axis);
                }
            }
            return bounds;
        }

        private ArraySegment<byte> Thumbnail(Block block)
        {
            var bytes = new ReadOnlySpan<byte>(content, block.Offset, block.Count);
            if (block.Count != 0 && !bytes.StartsWith(PngSignature))
            {
                throw Refusal.Of("thumbnail", "the content is no PNG");
            }
            return new ArraySegment<byte>(content, block.Offset, block.Count);
        }
    }
}
