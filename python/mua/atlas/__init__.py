"""One texture space and one image for all materials of a character: charts, their density, what the image shows."""
