"""How much a scene takes that a server keeps."""

import numpy as np

from elbowroom.world.scene import Scene

_EACH = 1500  # bytes of memory beside the arrays, of an obstacle or a piece of a mesh


def weight_of(scene: Scene) -> int:
    """Bytes: what kernels read of the scene, what Python keeps of each piece beside it, and the file it is shown with.

    Of places with 80 to 180,000 triangles that tells the memory within a third. What is not made yet is made for it.
    """
    glb = scene.place.glb if scene.place is not None else None
    arrays = _arrays(scene.obstacles.standing) + _arrays(scene.ground)
    return arrays + _EACH * len(scene.obstacles.names) + (glb.stat().st_size if glb is not None else 0)


def _arrays(fields: tuple[object, ...]) -> int:
    return sum(field.nbytes for field in fields if isinstance(field, np.ndarray))
