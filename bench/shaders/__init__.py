"""Shader code in many languages: reading, writing, running and counting of instructions."""
