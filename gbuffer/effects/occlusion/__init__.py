"""Code that the ambient occlusion methods share."""
