"""How fast the quality table is measured, next to C, NumPy and reading the input."""
