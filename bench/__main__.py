"""`python -m normalbench.bench` is `normalbench`."""

import sys

from .cli import main

sys.exit(main())
