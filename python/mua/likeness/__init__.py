"""How much the splats of a character look like the character that its file holds."""
