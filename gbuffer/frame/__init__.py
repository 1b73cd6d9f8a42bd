"""A frame's configuration and its resources."""
