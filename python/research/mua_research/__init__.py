"""The systems of the paper's tables, built from their descriptions and trained beside ours."""
