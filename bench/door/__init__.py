"""Entry points for users: the command line, gates, tests and Python."""
