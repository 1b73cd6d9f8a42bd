"""What the parity test gives to the two languages, and how it compares what they make of it: a module for each kind."""
