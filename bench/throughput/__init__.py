"""How fast the quality table is measured, against NumPy."""
