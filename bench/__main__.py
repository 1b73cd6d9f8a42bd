"""`python -m normalbench.bench` is `normalbench`."""

from .cli.app import program

program()
