"""glTF and VRM files, by pygltflib."""
