"""The fewest bytes per pixel for an image quality."""
