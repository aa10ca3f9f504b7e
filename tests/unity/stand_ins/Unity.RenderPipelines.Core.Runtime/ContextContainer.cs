// Stand-in. Source: Unity's Graphics repository, com.unity.render-pipelines.core 17.0, Runtime/Common/ContextContainer.cs.
using System;
using System.Collections.Generic;

namespace UnityEngine.Rendering
{
    public abstract class ContextItem
    {
        public abstract void Reset();
    }

    public class ContextContainer
    {
        private readonly Dictionary<Type, ContextItem> items = new Dictionary<Type, ContextItem>();

        public T Get<T>() where T : ContextItem, new() { return (T)items[typeof(T)]; }
        public T GetOrCreate<T>() where T : ContextItem, new()
        {
            ContextItem item;
            if (!items.TryGetValue(typeof(T), out item))
                items[typeof(T)] = item = new T();
            return (T)item;
        }
    }
}
