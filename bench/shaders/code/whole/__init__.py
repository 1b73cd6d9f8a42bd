"""Code that packs and unpacks a whole G-buffer: `code --of layout` writes, runs and compares it."""
