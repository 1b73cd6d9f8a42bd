"""What tables have in common, by the names that people give it."""
