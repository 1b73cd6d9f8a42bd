"""Shader macros and kernels as text, which need no OpenGL."""
