"""All output: rows, files, messages, progress, the journal and the cache."""
