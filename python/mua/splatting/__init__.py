"""Images of splats that can be differentiated: what the reference renderer draws, for training."""
