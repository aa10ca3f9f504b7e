"""The numpy reference of every GPU kernel, in frame order."""
