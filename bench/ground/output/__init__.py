"""Everything that is written: rows, files, messages, progress, the journal and the cache."""
