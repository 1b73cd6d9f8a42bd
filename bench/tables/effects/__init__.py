"""The effects table: what a code of the G-buffer does to effects that read it."""
