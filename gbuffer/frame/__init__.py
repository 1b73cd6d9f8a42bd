"""A frame: its plan, its resources, and what passes draw with."""
