"""Measuring in several processes, on this machine or on others, as selected by `--on`."""
