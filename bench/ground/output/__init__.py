"""What is written: rows, files, messages, progress, the journal and the cache."""
