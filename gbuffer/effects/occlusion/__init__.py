"""Ambient occlusion: what its methods share."""
