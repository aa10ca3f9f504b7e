// What the engine does around scripts: messages by name, and frames. Not part of Unity's API: for test programs only.
using System;
using System.Collections.Generic;
using System.Reflection;
using UnityEngine;

namespace StandIns
{
    public static class Messages
    {
        private const BindingFlags Own = BindingFlags.Instance | BindingFlags.Public | BindingFlags.NonPublic | BindingFlags.DeclaredOnly;
        private static readonly Dictionary<Type, Dictionary<string, MethodInfo>> Found = new Dictionary<Type, Dictionary<string, MethodInfo>>();
        private static readonly Dictionary<object, Dictionary<string, Action>> Bound = new Dictionary<object, Dictionary<string, Action>>();

        /// <summary>Call a method without arguments if the object has one; an exception is logged, as by the engine.</summary>
        public static void Send(UnityEngine.Object target, string message)
        {
            Dictionary<string, Action> actions;
            if (!Bound.TryGetValue(target, out actions))
                Bound[target] = actions = new Dictionary<string, Action>();
            Action action;
            if (!actions.TryGetValue(message, out action))
                actions[message] = action = Bind(target, message);
            if (action == null)
                return;
            try
            {
                action();
            }
            catch (Exception exception)
            {
                Debug.LogException(exception, target);
            }
        }

        private static Action Bind(UnityEngine.Object target, string message)
        {
            Dictionary<string, MethodInfo> methods;
            if (!Found.TryGetValue(target.GetType(), out methods))
                Found[target.GetType()] = methods = new Dictionary<string, MethodInfo>();
            MethodInfo method = null;
            for (Type type = target.GetType(); type != null && method == null && !methods.TryGetValue(message, out method); type = type.BaseType)
                method = type.GetMethod(message, Own, null, Type.EmptyTypes, null);
            methods[message] = method;
            return method == null ? null : (Action)Delegate.CreateDelegate(typeof(Action), target, method);
        }
    }

    /// <summary>Runs frames: Start, Update, coroutines, LateUpdate, onBeforeRender, then every camera.</summary>
    public static class PlayerLoop
    {
        private static readonly List<Behaviour> Running = new List<Behaviour>();

        /// <summary>
        /// Enters play mode without a reload of the domain: statics stay as they are, but for what methods that ask to be called
        /// then set anew.
        /// </summary>
        public static void StartGame()
        {
            foreach (Assembly assembly in AppDomain.CurrentDomain.GetAssemblies())
                foreach (Type type in assembly.GetTypes())
                    foreach (MethodInfo method in type.GetMethods(BindingFlags.Static | BindingFlags.Public | BindingFlags.NonPublic | BindingFlags.DeclaredOnly))
                        if (Attribute.IsDefined(method, typeof(RuntimeInitializeOnLoadMethodAttribute)))
                            method.Invoke(null, null);
        }

        /// <summary>One frame of so many seconds, and its cameras.</summary>
        public static void Frame(float seconds)
        {
            Time.Advance(seconds);
            Collect();
            for (int i = 0; i < Running.Count; i++)
            {
                if (Running[i].Running && !Running[i].Started)
                {
                    Running[i].Started = true;
                    Messages.Send(Running[i], "Start");
                }
            }
            SendAll("Update");
            for (int i = 0; i < Running.Count; i++)
            {
                MonoBehaviour script = Running[i] as MonoBehaviour;
                if (!ReferenceEquals(script, null) && script.Running)
                    script.StepCoroutines();
            }
            SendAll("LateUpdate");
            Application.BeforeRender();
            for (int i = 0; i < Running.Count; i++)
            {
                Camera camera = Running[i] as Camera;
                if (!ReferenceEquals(camera, null) && camera.Running)
                    camera.Render();
            }
        }

        private static void Collect()
        {
            Running.Clear();
            for (int i = 0; i < GameObject.All.Count; i++)
            {
                List<Component> components = GameObject.All[i].Components;
                for (int j = 0; j < components.Count; j++)
                {
                    Behaviour behaviour = components[j] as Behaviour;
                    if (!ReferenceEquals(behaviour, null) && behaviour.Running)
                        Running.Add(behaviour);
                }
            }
        }

        private static void SendAll(string message)
        {
            for (int i = 0; i < Running.Count; i++)
                if (Running[i].Running)
                    Messages.Send(Running[i], message);
        }
    }
}
