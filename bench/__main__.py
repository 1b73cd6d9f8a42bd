"""`python -m normalbench.bench` is `normalbench`."""

from .cli.start import program

program()
