"""What light buffers lose."""
