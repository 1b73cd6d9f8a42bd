"""`python -m normalbench.bench` is `normalbench`."""

from .cli import program

program()
