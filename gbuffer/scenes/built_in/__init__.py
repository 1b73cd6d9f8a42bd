"""The scenes that need no file, each in its own module."""
