"""The parity test's inputs for the two languages, and its comparison of their results: a module for each kind."""
