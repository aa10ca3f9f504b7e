using System;
using System.Linq;
using UnityEditor;

namespace Mua.Editor
{
    /// <summary>One setting of a project: what it is, what it should be, and how to make it so.</summary>
    internal sealed class ProjectSetting
    {
        public const string Absent = "absent";

        private readonly Func<string> read;
        private readonly Func<bool> isRight;
        private readonly Action write;
        private readonly string name;
        private readonly string wanted;

        public ProjectSetting(string name, string wanted, Func<string> read, Func<bool> isRight, Action write)
        {
            this.name = name;
            this.wanted = wanted;
            this.read = read;
            this.isRight = isRight;
            this.write = write;
        }

        /// <summary>Null where it is as it should be, else a sentence.</summary>
        public string Fault => isRight() ? null : $"{name} is {read()}, expected {wanted}";

        /// <summary>A setting with one right value.</summary>
        public static ProjectSetting Of<T>(string name, T wanted, Func<T> read, Action<T> write)
        {
            return Of(name, wanted, read, value => Text(value) == Text(wanted), write);
        }

        /// <summary>A setting with several right values, of which `wanted` is the one to write.</summary>
        public static ProjectSetting Of<T>(
            string name, T wanted, Func<T> read, Func<T, bool> isRight, Action<T> write)
        {
            return new ProjectSetting(
                name, Text(wanted), () => Text(read()), () => isRight(read()), () => write(wanted));
        }

        /// <summary>
        /// A setting of an object of the project that `find` gives. Where there is none it is absent, and `prepare` may make
        /// the object before it is written.
        /// </summary>
        public static ProjectSetting In<TObject, T>(
            string name, T wanted, Func<TObject> find, Func<TObject, T> read, Action<TObject, T> write, Action prepare = null)
            where TObject : UnityEngine.Object
        {
            Func<string> found = () =>
            {
                TObject holder = find();
                return holder == null ? Absent : Text(read(holder));
            };
            return new ProjectSetting(name, Text(wanted), found, () => found() == Text(wanted), () =>
            {
                prepare?.Invoke();
                TObject holder = find();
                if (holder != null)
                {
                    write(holder, wanted);
                    EditorUtility.SetDirty(holder);
                }
            });
        }

        /// <summary>Makes it right and says what was changed; null where nothing had to be, or could be.</summary>
        public string Make()
        {
            if (isRight())
            {
                return null;
            }
            string before = read();
            write();
            return isRight() ? $"{name}: {before} -> {read()}" : null;
        }

        private static string Text<T>(T value)
        {
            object each = value;
            if (each is bool)
            {
                return (bool)each ? "on" : "off";
            }
            var list = each as Array;
            return list == null ? Convert.ToString(each) : string.Join(", ", list.Cast<object>());
        }
    }
}
