// Plays every frame of every clip of a file through unity-package/Runtime/Motion for tests/unity/test_motion.py.

using System;
using System.Globalization;
using System.IO;
using Mua.Format;
using Mua.Motion;

internal static class MotionProgram
{
    private const int Repeats = 100;

    // Where the avatar stands: a turn about Y, then a step, in metres.
    private static readonly DualQuaternion Place =
        DualQuaternion.FromRigid(new QuaternionD(0.8, 0, 0.6, 0), new Vector3D(1, -2, 0.5));

    private static void Main(string[] arguments)
    {
        CultureInfo.CurrentCulture = CultureInfo.InvariantCulture;
        AvatarFile avatar = AvatarFile.Read(File.ReadAllBytes(arguments[0]));
        int joints = avatar.Skeleton.JointCount, window = avatar.Encoding.Window;
        var rotations = new double[4 * joints * window];
        var translations = new double[3 * joints * window];
        var inputs = new float[avatar.Encoding.ComponentCount];
        var skinning = new float[8 * joints];
        var weights = new float[avatar.Expressions == null ? 0 : avatar.Expressions.Names.Length];
        var descriptor = new Descriptor(avatar.Skeleton, avatar.Encoding);
        var pose = new SkeletonPose(avatar.Skeleton);
        foreach (Clip clip in avatar.Clips)
        {
            var sampler = new ClipSampler(clip, avatar.Skeleton, avatar.Encoding.Rate);
            Console.WriteLine("frames " + sampler.FrameCount);
            for (int frame = 0; frame < sampler.FrameCount; frame++)
            {
                double outside = Play(
                    sampler, frame, window, rotations, translations, inputs, skinning, descriptor, pose);
                sampler.ReadExpressions(frame, weights);
                Print("expressions", weights);
                Print("rotations", rotations);
                Print("translations", translations);
                Print("components", inputs);
                Print("outside", new[] { outside });
                Print("turned", pose.Turned);
                Print("placed", pose.Placed);
                Print("skinning", skinning);
                Print("root", new[] { pose.RootPosition.X, pose.RootPosition.Y, pose.RootPosition.Z });
            }
            for (int i = 1; i < arguments.Length; i++)
            {
                Console.WriteLine("at " + (int)sampler.Position(double.Parse(arguments[i])));
            }
            long before = GC.GetAllocatedBytesForCurrentThread();
            for (int i = 0; i < Repeats; i++)
            {
                int frame = (int)sampler.Position(0.01 * i);
                Play(sampler, frame, window, rotations, translations, inputs, skinning, descriptor, pose);
            }
            Console.WriteLine("allocated " + (GC.GetAllocatedBytesForCurrentThread() - before));
        }
    }

    private static double Play(
        ClipSampler sampler, int frame, int window, double[] rotations, double[] translations, float[] inputs,
        float[] skinning, Descriptor descriptor, SkeletonPose pose)
    {
        sampler.ReadWindow(frame, window, rotations, translations);
        double outside = descriptor.Write(rotations, translations, inputs);
        pose.Set(rotations, translations);
        pose.WriteSkinning(Place, skinning);
        return outside;
    }

    private static void Print(string name, Array values)
    {
        var bytes = new byte[Buffer.ByteLength(values)];
        Buffer.BlockCopy(values, 0, bytes, 0, bytes.Length);
        Console.WriteLine(name + " " + BitConverter.ToString(bytes).Replace("-", ""));
    }
}
