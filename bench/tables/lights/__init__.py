"""The accuracy of light buffers."""
