"""What Linux, macOS and Windows have each in their own way, behind one interface. No other module names any of it."""
