"""Where what compilers make is kept for all tests, their processes, the next run and other checkouts."""

from normalbench.bench.ground.output.cache import folder

COMPILED = folder().with_name("normalbench-tests")
