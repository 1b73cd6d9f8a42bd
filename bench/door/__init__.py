"""What users come in by: the command line, gates, tests and Python."""
