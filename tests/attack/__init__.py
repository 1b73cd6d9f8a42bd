"""Damaged files, hostile code, odd names and interruptions, each from a seed: `python -m tests.attack`."""
