"""The `elbowroom` command."""
