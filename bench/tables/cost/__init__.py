"""What encoding and decoding cost."""
