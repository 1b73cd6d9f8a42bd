"""Results folders, and what changed between two of them."""
