"""The figures, one file for each, and their common style."""
