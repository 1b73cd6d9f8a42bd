"""Results that are kept: rows, runs, and what changed between two of them."""
