"""The effect of codecs, layouts and light buffers on the final image."""
