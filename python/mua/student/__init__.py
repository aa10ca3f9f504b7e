"""The student: the bases and small networks that a file holds, and how they are trained on a recording."""
