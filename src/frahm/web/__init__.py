"""Room `web`: the interactive page of `frahm app`, served to this machine only."""
