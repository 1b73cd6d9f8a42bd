"""Thresholds and baselines that rows are held to."""
