"""The passes of the pipelines."""
