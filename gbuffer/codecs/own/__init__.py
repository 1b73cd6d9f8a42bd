"""Users' functions of any kind, by themselves."""
