"""The cost of encoding and decoding."""
