"""`python -m elbowroom` is the `elbowroom` command."""

from elbowroom.cli import main

main()
