"""The effects table: how encodings in the G-buffer affect effects that read it."""
