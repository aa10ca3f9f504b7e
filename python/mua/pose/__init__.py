"""Joints and poses: skeleton, clip, names of joints and expressions, the descriptor of a window of poses."""
