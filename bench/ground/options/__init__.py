"""Options as types, and things chosen by name."""
