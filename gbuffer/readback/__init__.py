"""A frame read back: the G-buffer unpacked, the image resolved."""
