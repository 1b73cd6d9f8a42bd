"""The motion table: how much a code's error changes from frame to frame."""
