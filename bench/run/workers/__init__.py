"""Measuring in several processes, on this machine or on others: what `--on` names."""
