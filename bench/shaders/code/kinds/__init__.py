"""What codes of each kind are: what their functions take and give, and what the catalogue makes of values."""
