"""Effects: passes that read what a pipeline keeps, and insert themselves behind a pass."""
