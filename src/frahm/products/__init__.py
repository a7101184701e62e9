"""Room `products`: the fewest kinds of absorber that serve every member of a platform."""
