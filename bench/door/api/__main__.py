"""`python -m normalbench` is `normalbench`, also where the folder of scripts is not on the path."""

from importlib import import_module

import_module(f"{__package__}.bench.door.cli.start").program()
