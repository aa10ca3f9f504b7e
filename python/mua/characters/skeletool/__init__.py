"""Files of Skeletool, as DDC, ASH and UMA have them."""
