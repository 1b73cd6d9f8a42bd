"""What `import normalbench` offers: tables as functions, and codecs on arrays."""
