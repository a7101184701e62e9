"""`python -m frahm` is the same as the command `frahm`."""

from frahm.cli import main

main()
