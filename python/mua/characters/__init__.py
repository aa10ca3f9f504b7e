"""Characters from files of FBX, glTF, VRM, USD and Skeletool: one surface on rigid joints, in metres."""
