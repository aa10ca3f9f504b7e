"""What is distilled: teachers that give a mesh and a Gaussian texture for any pose."""
