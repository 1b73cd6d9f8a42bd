"""How the time grows with the size of what is measured."""
