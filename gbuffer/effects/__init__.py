"""Effects: passes that read a pipeline's resources and are inserted after one of its passes."""
