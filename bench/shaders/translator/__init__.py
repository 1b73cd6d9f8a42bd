"""Translation of shader functions between languages: they are read as a tree and written as text."""
