"""How fast the program itself is: programs, and no tests. See `python -m tests.speed --help`."""
