"""Captures in the layouts of other programs: their cameras, poses and keypoints."""
