"""Room `published`."""
