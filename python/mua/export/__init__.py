"""An avatar in files that other programs open: splats, posed meshes, skeletons and motion."""
