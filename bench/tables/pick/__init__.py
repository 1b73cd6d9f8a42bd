"""Which code to take."""
