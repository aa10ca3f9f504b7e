"""What a frame costs on a device: time by kernel beside the bytes it moves and the operations it computes."""
