"""The `elbowroom` command."""


def main() -> None:
    """Run the command line: the entry point of the installed `elbowroom` script."""
    from elbowroom.cli.main import run

    run()
