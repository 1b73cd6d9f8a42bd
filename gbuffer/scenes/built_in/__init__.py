"""The scenes that need no file, a module for each."""
