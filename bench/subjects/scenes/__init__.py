"""Scenes by name, and captured frames as scenes."""
