"""Users' functions of any kind, run without storage."""
