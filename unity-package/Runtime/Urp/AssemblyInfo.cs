using UnityEngine.Scripting;

// Nothing refers to this assembly, so a player would be built without it.
[assembly: AlwaysLinkAssembly]
