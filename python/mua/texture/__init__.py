"""What texels hold: how the Gaussian of each lies on the surface, its colour, and what empty texels are filled with."""
