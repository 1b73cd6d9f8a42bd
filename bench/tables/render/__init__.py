"""What codecs, layouts and light buffers do to the final image."""
