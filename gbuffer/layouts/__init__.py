"""Assignment of attributes to the bits of render targets."""
