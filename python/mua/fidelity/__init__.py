"""How closely the splats of a character resemble the character in its file."""
