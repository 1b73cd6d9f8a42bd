"""A codec as code of many languages: written, run and compared."""
