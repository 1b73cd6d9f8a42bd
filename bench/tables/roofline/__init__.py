"""Bytes against instructions: which code is faster on which GPU."""
