"""The systems of the paper's tables, built from their descriptions, and what they are compared by."""
