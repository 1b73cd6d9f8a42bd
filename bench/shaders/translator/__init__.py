"""Shader functions from one language to another: read as a tree, and written as text."""
