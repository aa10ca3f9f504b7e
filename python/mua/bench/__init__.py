"""What a frame costs on a device: time by kernel beside the bytes and operations that it must take."""
