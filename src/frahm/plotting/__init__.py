"""Room `plotting`: static and interactive figures."""
