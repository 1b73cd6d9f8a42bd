"""`python -m normalbench.bench` is `normalbench`."""

from .door.cli.start import program

program()
