"""The speed of the program itself: programs rather than tests. See `python -m tests.speed --help`."""
