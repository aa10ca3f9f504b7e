using System.Runtime.CompilerServices;
using UnityEngine.Scripting;

[assembly: AlwaysLinkAssembly] // nothing in a scene refers to it: it starts by itself
[assembly: InternalsVisibleTo("Mua.Avatar.Editor")]
[assembly: InternalsVisibleTo("Mua.Avatar.Tests")]
[assembly: InternalsVisibleTo("Mua.Avatar.Editor.Tests")]
