// Stand-in. Source: Unity 6000.0, JsonUtility: public fields of [Serializable] classes; unknown names are ignored.
using System;
using System.Collections;
using System.Collections.Generic;
using System.Globalization;
using System.Reflection;
using System.Text;

namespace UnityEngine
{
    public static class JsonUtility
    {
        private const BindingFlags Fields = BindingFlags.Instance | BindingFlags.Public;

        public static T FromJson<T>(string json)
        {
            StandIns.JsonReader reader = new StandIns.JsonReader(json);
            return (T)Made(typeof(T), reader.Document());
        }
        public static string ToJson(object obj) { return ToJson(obj, false); }
        public static string ToJson(object obj, bool prettyPrint)
        {
            StringBuilder text = new StringBuilder();
            Write(obj, text);
            return text.ToString();
        }

        private static object Made(Type type, object value)
        {
            if (type == typeof(string))
                return value as string ?? "";
            if (type.IsPrimitive)
                return value is double ? Convert.ChangeType(value, type, CultureInfo.InvariantCulture) : Activator.CreateInstance(type);
            List<object> listed = value as List<object>;
            if (type.IsArray)
            {
                Array array = Array.CreateInstance(type.GetElementType(), listed == null ? 0 : listed.Count);
                for (int i = 0; i < array.Length; i++)
                    array.SetValue(Made(type.GetElementType(), listed[i]), i);
                return array;
            }
            Dictionary<string, object> members = value as Dictionary<string, object>;
            if (members == null || !type.IsSerializable)
                return null;
            object made = Activator.CreateInstance(type, true);
            foreach (FieldInfo field in type.GetFields(Fields))
                if (members.ContainsKey(field.Name))
                    field.SetValue(made, Made(field.FieldType, members[field.Name]));
            return made;
        }

        private static void Write(object value, StringBuilder text)
        {
            IFormattable number = value as IFormattable;
            if (value is string)
                text.Append('"').Append(((string)value).Replace("\\", "\\\\").Replace("\"", "\\\"")).Append('"');
            else if (number != null)
                text.Append(number.ToString(null, CultureInfo.InvariantCulture));
            else if (value is IEnumerable)
                WriteAll("[", (IEnumerable)value, text);
            else
                WriteFields(value, text);
        }

        private static void WriteAll(string begin, IEnumerable values, StringBuilder text)
        {
            foreach (object value in values)
            {
                text.Append(begin);
                Write(value, text);
                begin = ", ";
            }
            text.Append(begin == "[" ? "[]" : "]");
        }

        private static void WriteFields(object value, StringBuilder text)
        {
            string begin = "{";
            foreach (FieldInfo field in value.GetType().GetFields(Fields))
            {
                text.Append(begin).Append('"').Append(field.Name).Append("\": ");
                Write(field.GetValue(value), text);
                begin = ", ";
            }
            text.Append("}");
        }
    }
}

namespace StandIns
{
    /// <summary>JSON as dictionaries, lists, strings, doubles, booleans and null. Not part of Unity's API.</summary>
    internal sealed class JsonReader
    {
        private readonly string text;
        private int at;

        internal JsonReader(string text) { this.text = text; }

        internal object Document()
        {
            object found = Value();
            Require(Next() == '\0');
            return found;
        }

        private object Value()
        {
            char next = Next();
            if (next == '{')
                return Members();
            if (next == '[')
                return Items();
            if (next == '"')
                return Text();
            int begin = at;
            while (at < text.Length && (char.IsLetterOrDigit(text[at]) || "+-.".IndexOf(text[at]) >= 0))
                at++;
            string word = text.Substring(begin, at - begin);
            if (word == "null")
                return null;
            if (word == "true" || word == "false")
                return word == "true";
            double number;
            Require(double.TryParse(word, NumberStyles.Float, CultureInfo.InvariantCulture, out number));
            return number;
        }

        private Dictionary<string, object> Members()
        {
            Dictionary<string, object> found = new Dictionary<string, object>();
            for (at++; Next() != '}'; Skip('}'))
            {
                Require(Next() == '"');
                string name = Text();
                Require(Next() == ':');
                at++;
                found[name] = Value();
            }
            at++;
            return found;
        }

        private List<object> Items()
        {
            List<object> found = new List<object>();
            for (at++; Next() != ']'; Skip(']'))
                found.Add(Value());
            at++;
            return found;
        }

        private string Text()
        {
            int end = text.IndexOf('"', at + 1);
            Require(end > 0);
            string found = text.Substring(at + 1, end - at - 1);
            Require(found.IndexOf('\\') < 0); // no file of ours has escapes
            at = end + 1;
            return found;
        }

        /// <summary>The comma before another entry, if there is one.</summary>
        private void Skip(char end)
        {
            Require(Next() == ',' || Next() == end);
            at += Next() == ',' ? 1 : 0;
        }

        private char Next()
        {
            while (at < text.Length && char.IsWhiteSpace(text[at]))
                at++;
            return at < text.Length ? text[at] : '\0';
        }

        private void Require(bool isRight)
        {
            if (!isRight)
                throw new ArgumentException("JSON parse error at " + at);
        }
    }
}
