"""How near avatar files come to their teacher, or to the images of a capture: drawn, scored and set in tables."""
