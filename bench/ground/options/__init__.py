"""Options as typed fields, and values chosen by name."""
