"""`python -m normalbench.bench.throughput`."""

import sys

from .measure import main

sys.exit(main())
