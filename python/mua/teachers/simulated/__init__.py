"""A rigged character that moves like cloth and soft tissue, as a teacher."""
