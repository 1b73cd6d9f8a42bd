"""The subjects that tables share, by the names that users give them."""
