"""What only POSIX systems have, and the files that only Linux has. No other module of the program names any of it."""
