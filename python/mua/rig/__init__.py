"""A rig: skeleton, skinned template and the map of its texels; and what follows from them."""
