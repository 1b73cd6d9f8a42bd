"""Experiments, metrics, results and the command line."""
