"""Thresholds and baselines that rows are checked against."""
