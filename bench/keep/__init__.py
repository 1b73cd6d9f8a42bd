"""Stored results: rows, runs, and the changes between two runs."""
