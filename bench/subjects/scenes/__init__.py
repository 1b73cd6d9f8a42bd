"""Scenes by name, including captured frames as scenes."""
