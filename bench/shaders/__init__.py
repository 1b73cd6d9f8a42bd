"""Shader code: read, written, run and counted in many languages."""
