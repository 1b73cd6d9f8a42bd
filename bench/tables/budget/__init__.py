"""The smallest number of bytes per pixel for an image quality."""
