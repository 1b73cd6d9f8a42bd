"""The error of positions that are rebuilt from a stored depth."""
