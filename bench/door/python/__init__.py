"""The contents of `import normalbench`: tables as functions, and codecs for arrays."""
