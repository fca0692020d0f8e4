"""Numbers of ports."""

from elbowroom.errors import InputError

HIGHEST = 65535


def check_port(port: int) -> None:
    """Raises `InputError` for what is no port to listen on."""
    if not 0 <= port <= HIGHEST:
        raise InputError(f"--port {port}: a port is a whole number from 0 (any free one) to {HIGHEST}")
