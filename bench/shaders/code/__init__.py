"""A codec as code in many languages: written, run and compared."""
