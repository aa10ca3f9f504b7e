// Runs the reader of unity-package/Runtime/Format for tests/unity/test_format.py.

using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Text;
using Mua.Format;

internal static class FormatProgram
{
    /// <summary>Takes name, kind and bytes of a value that is dumped.</summary>
    private static Action<string, string, byte[]> print = PrintDigits;

    private static int Main(string[] arguments)
    {
        CultureInfo.CurrentCulture = CultureInfo.InvariantCulture;
        if (arguments[0] == "digests")
        {
            DigestAll(Console.OpenStandardInput());
            return 0;
        }
        byte[] content = File.ReadAllBytes(arguments[1]);
        switch (arguments[0])
        {
            case "dump":
                Dump(AvatarFile.Read(content));
                return 0;
            case "answers":
                foreach (string path in arguments.Skip(1))
                {
                    Console.WriteLine(Answer(File.ReadAllBytes(path)));
                }
                return 0;
            case "measured":
                Measure(arguments[1], int.Parse(arguments[2]));
                return 0;
            case "truncate":
                for (int length = 0; length < content.Length; length++)
                {
                    var cut = new byte[length];
                    Array.Copy(content, cut, length);
                    Console.WriteLine(Answer(cut));
                }
                return 0;
            case "halves":
                Print("halves", Enumerable.Range(0, 1 << 16).Select(bits => Half.ToSingle((ushort)bits)).ToArray());
                return 0;
            case "checksums":
                for (int count = 0; count < 64; count++)
                {
                    Console.WriteLine(Checksum.Append(Checksum.Append(0, content, 0, count), content, count, 2 * count + 1));
                }
                return 0;
            default:
                return 2;
        }
    }

    /// <summary>`ok`, or code and field of the refusal; any other exception ends the program.</summary>
    private static string Answer(byte[] content)
    {
        try
        {
            AvatarFile.Read(content);
            return "ok";
        }
        catch (AvatarFormatException error)
        {
            return error.Code + "\t" + error.Field + "\t" + error.Message;
        }
    }

    /// <summary>A line for each file that comes, after its length as four bytes.</summary>
    private static void DigestAll(Stream input)
    {
        var reader = new BinaryReader(input);
        for (byte[] length = reader.ReadBytes(4); length.Length == 4; length = reader.ReadBytes(4))
        {
            Console.WriteLine(Digest(reader.ReadBytes(BitConverter.ToInt32(length, 0))));
        }
    }

    /// <summary>Reads a file so many times: for each, seconds of the processor and by the clock; the most bytes of the first.</summary>
    private static void Measure(string path, int runs)
    {
        long before = Status("VmRSS:"), taken = 0;
        var process = System.Diagnostics.Process.GetCurrentProcess();
        List<string> seconds = new List<string>(), waited = new List<string>();
        for (int run = 0; run < runs; run++)
        {
            process.Refresh();
            double start = process.TotalProcessorTime.TotalSeconds;
            var clock = System.Diagnostics.Stopwatch.StartNew();
            AvatarFile avatar = AvatarFile.Read(File.ReadAllBytes(path));
            waited.Add(clock.Elapsed.TotalSeconds.ToString("F3"));
            process.Refresh();
            seconds.Add((process.TotalProcessorTime.TotalSeconds - start).ToString("F3"));
            taken = run == 0 ? Status("VmHWM:") - before : taken;
            GC.KeepAlive(avatar);
        }
        Console.WriteLine("[[" + string.Join(", ", seconds) + "], [" + string.Join(", ", waited) + "], " + taken + "]");
    }

    /// <summary>A line of what Linux says of this process, bytes.</summary>
    private static long Status(string name)
    {
        string line = File.ReadLines("/proc/self/status").First(one => one.StartsWith(name));
        return 1024 * long.Parse(line.Substring(name.Length).Replace("kB", ""));
    }

    /// <summary>The bytes that reading takes, then the answer, for a sound file with a digest of all its values.</summary>
    private static string Digest(byte[] content)
    {
        long before = GC.GetAllocatedBytesForCurrentThread();
        string answer = Answer(content);
        string allocated = GC.GetAllocatedBytesForCurrentThread() - before + "\t";
        if (answer != "ok")
        {
            return allocated + answer;
        }
        ulong sum = 0;
        print = (name, kind, bytes) => sum += Checksum.Append(
            Checksum.Append(0, Encoding.UTF8.GetBytes(name + kind), 0, name.Length + kind.Length), bytes, 0, bytes.Length);
        Dump(AvatarFile.Read(content));
        return allocated + "ok\t" + sum;
    }

    /// <summary>Every value as `name kind hex`.</summary>
    private static void Dump(AvatarFile avatar)
    {
        foreach (KeyValuePair<string, Tensor> pair in Tensors(avatar))
        {
            Print(pair.Key, pair.Value);
        }
        Print("name", avatar.Name);
        Print("producer", avatar.Producer);
        Print("notes", avatar.Notes);
        Print("skeleton.names", string.Join("\n", avatar.Skeleton.Names));
        Print("skeleton.parents", avatar.Skeleton.Parents);
        Print("skeleton.bind_rotations", avatar.Skeleton.BindRotations);
        Print("skeleton.bind_translations", avatar.Skeleton.BindTranslations);
        Print("skeleton.bind_inverse", avatar.Skeleton.BindInverse);
        Print("skeleton.root", new[] { avatar.Skeleton.Root });
        Print("skeleton.translated", avatar.Skeleton.Translated);
        Print("encoding.translated", avatar.Encoding.Translated);
        Print("encoding.joints", avatar.Encoding.Joints);
        Print("encoding.rate", new[] { avatar.Encoding.Rate });
        Print("encoding.window", new[] { avatar.Encoding.Window, avatar.Encoding.Heading ? 1 : 0 });
        Print("encoding.mean", avatar.Encoding.Mean);
        Print("encoding.scale", avatar.Encoding.Scale);
        Print("encoding.ranges", avatar.Encoding.Ranges);
        Print("encoding.margins", avatar.Encoding.Margins);
        Print("wavelet.name", avatar.Wavelet.Name);
        Print("wavelet.levels", new[] { avatar.Wavelet.Levels });
        Print("wavelet.rec_lo", avatar.Wavelet.RecLo);
        Print("wavelet.rec_hi", avatar.Wavelet.RecHi);
        Print("texels.size", new[] { avatar.Texels.Size });
        if (avatar.Texels.OneSided != null)
        {
            print("texels.one_sided", "u1", avatar.Texels.OneSided);
        }
        Print("bounds", avatar.Bounds);
        ArraySegment<byte> thumbnail = avatar.Thumbnail;
        print("thumbnail", "u1", thumbnail.Array.Skip(thumbnail.Offset).Take(thumbnail.Count).ToArray());
        if (avatar.Surface != null)
        {
            Print("surface.triangles", avatar.Surface.Triangles(avatar.Texels));
        }
        if (avatar.Expressions != null)
        {
            Print("expressions.names", string.Join("\n", avatar.Expressions.Names));
        }
        for (int i = 0; i < avatar.Clips.Length; i++)
        {
            Print("clips." + i + ".name", avatar.Clips[i].Name);
            Print("clips." + i + ".rate", new[] { avatar.Clips[i].Rate });
        }
    }

    private static IEnumerable<KeyValuePair<string, Tensor>> Tensors(AvatarFile avatar)
    {
        var tensors = new List<KeyValuePair<string, Tensor>>();
        Action<string, Tensor> add = (name, tensor) => tensors.Add(new KeyValuePair<string, Tensor>(name, tensor));
        add("template.faces", avatar.Template.Faces);
        add("template.uv", avatar.Template.Uv);
        add("template.uv_faces", avatar.Template.UvFaces);
        add("template.skin_indices", avatar.Template.SkinIndices);
        add("template.skin_weights", avatar.Template.SkinWeights);
        add("texels.texels", avatar.Texels.Indices);
        add("texels.triangles", avatar.Texels.Triangles);
        add("texels.barycentrics", avatar.Texels.Barycentrics);
        add("encoding.components", avatar.Encoding.Components);
        add("coarse.mean", avatar.Coarse.Mean);
        add("coarse.basis", avatar.Coarse.Basis);
        AddMlp("coarse", avatar.Coarse.Mlp, add);
        AddBranch("geometry", avatar.Geometry, add);
        AddBranch("appearance", avatar.Appearance, add);
        for (int i = 0; i < avatar.Clips.Length; i++)
        {
            add("clips." + i + ".rotations", avatar.Clips[i].Rotations);
            add("clips." + i + ".translation", avatar.Clips[i].Translation);
            if (avatar.Clips[i].Translations != null)
            {
                add("clips." + i + ".translations", avatar.Clips[i].Translations);
            }
            if (avatar.Clips[i].Expressions != null)
            {
                add("clips." + i + ".expressions", avatar.Clips[i].Expressions);
            }
        }
        if (avatar.Expressions != null)
        {
            add("expressions.starts", avatar.Expressions.Starts);
            add("expressions.vertices", avatar.Expressions.Vertices);
            add("expressions.offsets", avatar.Expressions.Offsets);
            if (avatar.Expressions.Gains != null)
            {
                add("expressions.gains", avatar.Expressions.Gains);
            }
            if (avatar.Expressions.Rules != null)
            {
                add("expressions.rules", avatar.Expressions.Rules);
            }
        }
        return tensors;
    }

    private static void AddBranch(string name, Branch branch, Action<string, Tensor> add)
    {
        AddMlp(name, branch.Mlp, add);
        add(name + ".ll_mean", branch.LlMean);
        add(name + ".ll_basis", branch.LlBasis);
        add(name + ".static_offset", branch.StaticOffset);
        for (int i = 0; i < branch.Details.Length; i++)
        {
            add(name + ".details." + i + ".mean", branch.Details[i].Mean);
            add(name + ".details." + i + ".h", branch.Details[i].H);
            add(name + ".details." + i + ".w", branch.Details[i].W);
        }
    }

    private static void AddMlp(string name, Layer[] mlp, Action<string, Tensor> add)
    {
        for (int i = 0; i < mlp.Length; i++)
        {
            add(name + ".mlp." + i + ".weight", mlp[i].Weight);
            add(name + ".mlp." + i + ".bias", mlp[i].Bias);
        }
    }

    private static void Print(string name, Tensor tensor)
    {
        bool isWhole = tensor.Type == ElementType.I32;
        Print(name, isWhole ? (Array)tensor.Integers.ToArray() : tensor.ToFloats());
    }

    private static void Print(string name, Array values)
    {
        string kind = values is int[] ? "i4" : values is float[] ? "f4" : "f8";
        var bytes = new byte[Buffer.ByteLength(values)];
        Buffer.BlockCopy(values, 0, bytes, 0, bytes.Length);
        print(name, kind, bytes);
    }

    private static void Print(string name, string text)
    {
        print(name, "text", Encoding.UTF8.GetBytes(text));
    }

    private static void PrintDigits(string name, string kind, byte[] bytes)
    {
        var hex = new StringBuilder(2 * bytes.Length);
        foreach (byte value in bytes)
        {
            hex.Append("0123456789abcdef"[value >> 4]).Append("0123456789abcdef"[value & 15]);
        }
        Console.WriteLine(name + "\t" + kind + "\t" + hex);
    }
}
