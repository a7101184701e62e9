"""Room `loads`."""
