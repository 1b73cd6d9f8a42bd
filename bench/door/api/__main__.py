"""Entry point of `python -m normalbench`: works like `normalbench`, even if the scripts folder is not on the path."""

from importlib import import_module

import_module(f"{__package__}.bench.door.cli.start").program()
