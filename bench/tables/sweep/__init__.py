"""How each pipeline's passes grow with the number of objects."""
