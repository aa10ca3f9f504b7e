"""FBX files, by ufbx in a process of its own."""
