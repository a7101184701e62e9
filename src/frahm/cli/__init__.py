"""Room `cli`: the command `frahm`."""


def main() -> None:
    """Run the command line."""
