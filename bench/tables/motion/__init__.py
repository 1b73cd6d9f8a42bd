"""The motion table: how much an encoding's error changes from frame to frame."""
