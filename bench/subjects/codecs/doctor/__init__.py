"""Likely mistakes in a user's encoder and decoder: each is tried by itself, and both together."""
