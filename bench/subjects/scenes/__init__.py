"""Scenes as they are named, and captured frames as scenes."""
