"""Room `continuation`."""
