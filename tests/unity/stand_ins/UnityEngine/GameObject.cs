// Stand-in. Source: Unity 6000.0 scripting reference, GameObject, Component, Behaviour, MonoBehaviour, Transform.
using System;
using System.Collections;
using System.Collections.Generic;

namespace UnityEngine
{
    public enum PrimitiveType { Sphere, Capsule, Cylinder, Cube, Plane, Quad }

    public class Component : Object
    {
        public GameObject gameObject { get; internal set; }
        public override string name
        {
            get { return gameObject == null ? "" : gameObject.name; }
            set
            {
                if (gameObject != null)
                    gameObject.name = value;
            }
        }
        public Transform transform { get { return gameObject.transform; } }
        public string tag { get; set; }

        public T GetComponent<T>() { return gameObject.GetComponent<T>(); }
        public bool TryGetComponent<T>(out T component) { return gameObject.TryGetComponent(out component); }
        public T GetComponentInChildren<T>() { return gameObject.GetComponentInChildren<T>(); }
        public T GetComponentInParent<T>() { return gameObject.GetComponentInParent<T>(); }
        public T[] GetComponentsInChildren<T>() { return gameObject.GetComponentsInChildren<T>(); }
        public T[] GetComponentsInChildren<T>(bool includeInactive) { return gameObject.GetComponentsInChildren<T>(includeInactive); }
    }

    public class Behaviour : Component
    {
        private bool isEnabled = true;

        public bool isActiveAndEnabled { get { return isEnabled && gameObject.activeInHierarchy; } }
        public bool enabled
        {
            get { return isEnabled; }
            set
            {
                isEnabled = value;
                Refresh();
            }
        }

        internal bool Awoken, Started, Running;

        /// <summary>Send OnEnable or OnDisable where the state has changed.</summary>
        internal void Refresh()
        {
            bool active = gameObject.activeInHierarchy;
            if (active && !Awoken)
            {
                Awoken = true;
                StandIns.Messages.Send(this, "Awake");
            }
            bool runs = active && isEnabled && !destroyed;
            if (runs == Running)
                return;
            Running = runs;
            StandIns.Messages.Send(this, runs ? "OnEnable" : "OnDisable");
        }

        internal override void OnDestroyed()
        {
            if (Running)
            {
                Running = false;
                StandIns.Messages.Send(this, "OnDisable");
            }
            if (Awoken)
                StandIns.Messages.Send(this, "OnDestroy");
            gameObject.Components.Remove(this);
        }
    }

    public class YieldInstruction { }
    public class AsyncOperation : YieldInstruction { public virtual bool isDone { get { return true; } } public float progress { get { return 1; } } }
    public sealed class Coroutine : YieldInstruction { internal Stack<IEnumerator> Calls = new Stack<IEnumerator>(); }

    public class MonoBehaviour : Behaviour
    {
        internal readonly List<Coroutine> Coroutines = new List<Coroutine>();

        public Coroutine StartCoroutine(IEnumerator routine)
        {
            if (!isActiveAndEnabled)
                throw new InvalidOperationException("Coroutine couldn't be started because the game object '" + gameObject.name + "' is inactive!");
            Coroutine started = new Coroutine();
            started.Calls.Push(routine);
            Coroutines.Add(started);
            Step(started);
            return started;
        }
        public void Invoke(string methodName, float time) { StandIns.Messages.Send(this, methodName); }
        public static void print(object message) { Debug.Log(message); }

        internal void StepCoroutines()
        {
            for (int i = Coroutines.Count - 1; i >= 0; i--)
                if (i < Coroutines.Count)
                    Step(Coroutines[i]);
        }

        internal override void OnDestroyed()
        {
            Coroutines.Clear();
            base.OnDestroyed();
        }

        private void Step(Coroutine coroutine)
        {
            while (coroutine.Calls.Count > 0)
            {
                IEnumerator top = coroutine.Calls.Peek();
                AsyncOperation pending = top.Current as AsyncOperation;
                if (pending != null && !pending.isDone)
                    return;
                if (!top.MoveNext())
                {
                    coroutine.Calls.Pop();
                    continue;
                }
                IEnumerator inner = top.Current as IEnumerator;
                if (inner == null)
                    return; // every other instruction waits for one frame here
                coroutine.Calls.Push(inner);
            }
            Coroutines.Remove(coroutine);
        }
    }

    public sealed class GameObject : Object
    {
        internal static readonly List<GameObject> All = new List<GameObject>();
        internal readonly List<Component> Components = new List<Component>();
        private bool active = true;

        public GameObject() : this("New Game Object") { }
        public GameObject(string name)
        {
            this.name = name;
            transform = new Transform { gameObject = this };
            Components.Add(transform);
            All.Add(this);
        }
        public GameObject(string name, params Type[] components) : this(name)
        {
            foreach (Type type in components)
                AddComponent(type);
        }

        public Transform transform { get; private set; }
        public int layer { get; set; }
        public ulong sceneCullingMask { get { return StandIns.Stages.Opened.Contains(this) ? 1UL : 1UL << 63 | 2UL; } } // of the opened prefab; of the game and the scene view
        public string tag { get; set; }
        public bool activeSelf { get { return active; } }
        public bool activeInHierarchy
        {
            get { return !destroyed && active && (transform.parent == null || transform.parent.gameObject.activeInHierarchy); }
        }

        public void SetActive(bool value)
        {
            active = value;
            RefreshAll();
        }
        public T AddComponent<T>() where T : Component { return (T)AddComponent(typeof(T)); }
        public Component AddComponent(Type componentType)
        {
            Component made = (Component)Activator.CreateInstance(componentType, true);
            made.gameObject = this;
            made.name = name;
            Components.Add(made);
            Behaviour behaviour = made as Behaviour;
            if (behaviour != null)
                behaviour.Refresh();
            return made;
        }
        public T GetComponent<T>()
        {
            T found;
            TryGetComponent(out found);
            return found;
        }
        public bool TryGetComponent<T>(out T component)
        {
            for (int i = 0; i < Components.Count; i++)
            {
                if (Components[i] is T)
                {
                    component = (T)(object)Components[i];
                    return true;
                }
            }
            component = default(T);
            return false;
        }
        public T GetComponentInChildren<T>()
        {
            T[] found = GetComponentsInChildren<T>();
            return found.Length > 0 ? found[0] : default(T);
        }
        public T GetComponentInParent<T>()
        {
            for (Transform at = transform; at != null; at = at.parent)
            {
                T found;
                if (at.gameObject.TryGetComponent(out found))
                    return found;
            }
            return default(T);
        }
        public T[] GetComponentsInChildren<T>() { return GetComponentsInChildren<T>(false); }
        public T[] GetComponentsInChildren<T>(bool includeInactive)
        {
            List<T> found = new List<T>();
            Collect(transform, found, includeInactive);
            return found.ToArray();
        }
        public static GameObject Find(string name) { return All.Find(g => g.name == name && g.activeInHierarchy); }
        public static GameObject CreatePrimitive(PrimitiveType type)
        {
            GameObject made = new GameObject(type.ToString());
            made.AddComponent<MeshFilter>();
            made.AddComponent<MeshRenderer>();
            return made;
        }

        internal override void OnDestroyed()
        {
            for (int i = transform.childCount - 1; i >= 0; i--)
                DestroyImmediate(transform.GetChild(i).gameObject);
            foreach (Component component in Components.ToArray())
                DestroyImmediate(component);
            transform.SetParent(null);
            All.Remove(this);
        }

        private void RefreshAll()
        {
            foreach (Component component in Components.ToArray())
                if (component is Behaviour)
                    ((Behaviour)component).Refresh();
            for (int i = 0; i < transform.childCount; i++)
                transform.GetChild(i).gameObject.RefreshAll();
        }

        private static void Collect<T>(Transform at, List<T> found, bool inactive)
        {
            if (!inactive && !at.gameObject.activeInHierarchy)
                return;
            foreach (Component component in at.gameObject.Components)
                if (component is T)
                    found.Add((T)(object)component);
            for (int i = 0; i < at.childCount; i++)
                Collect(at.GetChild(i), found, inactive);
        }
    }

    public class Transform : Component, IEnumerable
    {
        private readonly List<Transform> children = new List<Transform>();

        public Transform() { localRotation = Quaternion.identity; localScale = Vector3.one; }

        public Vector3 localPosition { get; set; }
        public Quaternion localRotation { get; set; }
        public Vector3 localScale { get; set; }
        public Vector3 eulerAngles { get { return rotation.eulerAngles; } set { rotation = Quaternion.Euler(value); } }
        public Transform parent { get; private set; }
        public Transform root { get { return parent == null ? this : parent.root; } }
        public int childCount { get { return children.Count; } }
        public Matrix4x4 localToWorldMatrix
        {
            get
            {
                Matrix4x4 local = Matrix4x4.TRS(localPosition, localRotation, localScale);
                return parent == null ? local : parent.localToWorldMatrix * local;
            }
        }
        public Matrix4x4 worldToLocalMatrix { get { return localToWorldMatrix.inverse; } }
        public Vector3 position
        {
            get { return parent == null ? localPosition : parent.TransformPoint(localPosition); }
            set { localPosition = parent == null ? value : parent.InverseTransformPoint(value); }
        }
        public Quaternion rotation
        {
            get { return parent == null ? localRotation : parent.rotation * localRotation; }
            set { localRotation = parent == null ? value : Quaternion.Inverse(parent.rotation) * value; }
        }
        public Vector3 lossyScale
        {
            get
            {
                Matrix4x4 rest = Matrix4x4.Rotate(Quaternion.Inverse(rotation)) * localToWorldMatrix;
                return new Vector3(rest.m00, rest.m11, rest.m22);
            }
        }
        public Vector3 forward { get { return rotation * Vector3.forward; } set { rotation = Quaternion.LookRotation(value); } }
        public Vector3 right { get { return rotation * Vector3.right; } }
        public Vector3 up { get { return rotation * Vector3.up; } }

        public void SetParent(Transform p) { SetParent(p, true); }
        public void SetParent(Transform parent, bool worldPositionStays)
        {
            Vector3 place = position;
            Quaternion turn = rotation;
            if (this.parent != null)
                this.parent.children.Remove(this);
            this.parent = parent;
            if (parent != null)
                parent.children.Add(this);
            if (worldPositionStays)
            {
                position = place;
                rotation = turn;
            }
        }
        public Transform GetChild(int index) { return children[index]; }
        public Transform Find(string n)
        {
            string[] path = n.Split(new[] { '/' }, 2);
            Transform child = children.Find(c => c.gameObject.name == path[0]);
            return child == null || path.Length == 1 ? child : child.Find(path[1]);
        }
        public void SetPositionAndRotation(Vector3 position, Quaternion rotation)
        {
            this.position = position;
            this.rotation = rotation;
        }
        public void SetLocalPositionAndRotation(Vector3 localPosition, Quaternion localRotation)
        {
            this.localPosition = localPosition;
            this.localRotation = localRotation;
        }
        public void GetPositionAndRotation(out Vector3 position, out Quaternion rotation)
        {
            position = this.position;
            rotation = this.rotation;
        }
        public Vector3 TransformPoint(Vector3 p) { return localToWorldMatrix.MultiplyPoint3x4(p); }
        public Vector3 InverseTransformPoint(Vector3 p) { return worldToLocalMatrix.MultiplyPoint3x4(p); }
        public void Rotate(float x, float y, float z) { localRotation = localRotation * Quaternion.Euler(x, y, z); }
        public void Rotate(Vector3 axis, float angle) { localRotation = localRotation * Quaternion.AngleAxis(angle, axis); }
        public void RotateAround(Vector3 point, Vector3 axis, float angle)
        {
            Quaternion turn = Quaternion.AngleAxis(angle, axis);
            position = point + turn * (position - point);
            rotation = turn * rotation;
        }
        public void Translate(Vector3 translation) { position += rotation * translation; }
        public void LookAt(Vector3 worldPosition) { rotation = Quaternion.LookRotation(worldPosition - position); }
        public void LookAt(Transform target) { LookAt(target.position); }
        public IEnumerator GetEnumerator() { return children.GetEnumerator(); }
    }
}

namespace StandIns
{
    /// <summary>Objects of the prefab that is open; a scene view shows them alone. Not part of Unity's API.</summary>
    public static class Stages { public static readonly List<UnityEngine.GameObject> Opened = new List<UnityEngine.GameObject>(); }
}
