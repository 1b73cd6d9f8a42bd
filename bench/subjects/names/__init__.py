"""The subjects that tables share, by the names that people give them."""
