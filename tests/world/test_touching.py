"""Whether capsules touch a large mesh: never said to be free where they are not, and as the clearance kernel says."""

import numpy as np
import pytest

from elbowroom.world.obstacles.clearance import clearance
from elbowroom.world.obstacles.meshes.touching import Touching
from elbowroom.world.obstacles.rows import rows_of
from elbowroom.world.obstacles.shapes import Mesh
from sampled import sampled
from shapes import box_mesh, soup

UPRIGHT = np.array([[0.0, 0.0, 0.0, 1.0]])
CLOSE = 1e-5  # metres: nearer to touching than this, either may be said


def slivers() -> Mesh:
    """Needles, triangles without width, and the same twice."""
    rng = np.random.default_rng(3)
    begins, ends = rng.uniform(-0.5, 0.5, (2, 30, 3))
    corners = np.stack([begins, ends, 0.5 * (begins + ends) + rng.choice([0.0, 1e-7, 1e-3], (30, 1))], axis=1)
    corners = np.concatenate([corners, corners[:10], np.repeat(begins[:5, None], 3, axis=1)])
    return Mesh(corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))


MESHES = {
    "soup": soup(np.random.default_rng(1), 900, 0.2),
    "one": soup(np.random.default_rng(2), 1, 0.4),
    "slivers": slivers(),
    "wall": box_mesh((1.0, 1.0, 0.0005)),
    "plate": box_mesh((6.0, 0.01, 6.0)),
}


@pytest.mark.parametrize(
    ("name", "far"),
    [
        *sampled([(name, 0.0) for name in MESHES], [("one", 0.0), ("slivers", 0.0), ("wall", 0.0)]),
        pytest.param("soup", 5000.0, marks=pytest.mark.long),
    ],
)
def test_what_touches_is_what_the_clearance_kernel_says(name: str, far: float) -> None:
    mesh, rng, radius = MESHES[name], np.random.default_rng(4), 0.06
    begins = rng.uniform(mesh.middle - mesh.half - 0.6, mesh.middle + mesh.half + 0.6, (1000, 3)).T
    steps = rng.uniform(-0.4, 0.4, (3, 1000)) * rng.choice([0.0, 1.0, 3.0], 1000)
    segments = np.concatenate([begins, begins + steps])
    near = rows_of([mesh], np.zeros((1, 3)), UPRIGHT)
    exact = clearance(segments[None], [radius], near)
    field = Touching(Mesh(mesh.vertices + far, mesh.faces))
    found = field.touches((segments + far)[None], [radius])[0]
    sure = np.abs(exact) > CLOSE
    assert 5 < found.sum() < 995
    np.testing.assert_array_equal(found[sure], exact[sure] < 0.0)
    seen = (segments - np.tile(mesh.middle, 2)[:, None])[None].astype(np.float32)
    alone = field.touches_a_triangle(seen, np.array([radius], np.float32))[0]
    np.testing.assert_array_equal(alone[sure], exact[sure] < 0.0)
