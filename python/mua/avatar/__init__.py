"""An avatar in use: its model decoded, its levels of detail, its splats drawn on the CPU."""
