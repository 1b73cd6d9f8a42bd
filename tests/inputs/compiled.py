"""The folder of compiled programs that all tests, their processes, the next run and other checkouts share."""

from normalbench.bench.ground.output.cache import folder

COMPILED = folder().with_name("normalbench-tests")
