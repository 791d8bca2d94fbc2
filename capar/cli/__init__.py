"""The commands, one module each: they parse, call and print."""


def main() -> None:
    """Run the command line."""
