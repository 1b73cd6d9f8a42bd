"""Code that packs and unpacks a whole G-buffer: what `code --of layout` writes, runs and compares."""
