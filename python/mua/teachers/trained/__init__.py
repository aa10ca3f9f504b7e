"""A teacher of one's own, trained from a capture: the drivable template, and the splats on it."""
