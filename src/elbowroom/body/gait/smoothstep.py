"""From one to the other without a jolt at either end."""

from elbowroom.jit import inner_kernel


@inner_kernel
def smoothstep(x: float) -> float:
    """The cubic 3x^2 - 2x^3, 0 below 0 and 1 above 1."""
    t = min(max(x, 0.0), 1.0)
    return float(t * t * (3.0 - 2.0 * t))
