"""Head and neck as clay: a soft, slightly stylised adult face."""

import numpy as np

from make_stock_avatar.fields import Array, carved, common, ellipsoid, mirrored, normals, round_cone, sphere, union
from make_stock_avatar.loft import Row, loft
from make_stock_avatar.polygonise import Mesh
from make_stock_avatar.rest import EYE_CENTRE

# y, half-widths in x and z, centre in x and z
_NECK: tuple[Row, ...] = (
    (1.360, 0.0900, 0.0620, 0.0, -0.020),
    (1.420, 0.0620, 0.0560, 0.0, -0.020),
    (1.450, 0.0500, 0.0510, 0.0, -0.022),
    (1.490, 0.0460, 0.0490, 0.0, -0.020),
    (1.540, 0.0460, 0.0500, 0.0, -0.016),
)


def skull(q: Array) -> Array:
    """Cranium and jaw without features, the base of the hair."""
    cranium = ellipsoid(q, (0.0, 1.622, -0.010), (0.0785, 0.100, 0.0980))
    face = ellipsoid(q, (0.0, 1.572, 0.022), (0.0660, 0.090, 0.0690))
    jaw = ellipsoid(q, (0.0, 1.522, 0.036), (0.0470, 0.046, 0.0480))
    return union(union(cranium, face, 0.03), jaw, 0.03)


def _plain_face(q: Array) -> Array:
    """The skull with chin, cheeks and the surroundings of the eyes."""
    chin = sphere(q, (0.007, 1.4995, 0.0680), 0.0190)
    cheek = ellipsoid(q, (0.036, 1.553, 0.055), (0.030, 0.029, 0.030))
    orbit = ellipsoid(q, (0.041, 1.590, 0.048), (0.0265, 0.032, 0.0245))
    return union(union(union(skull(q), chin, 0.03), cheek, 0.025), orbit, 0.025)


def calm(mesh: Mesh, share: float = 0.45) -> Mesh:
    """The head with the normals of its face turned by `share` towards those of a plainer face, for a clean light."""
    plain = normals(lambda p: _plain_face(mirrored(p)), mesh.points)
    front = (
        share
        * np.clip((mesh.points[:, 2] - 0.02) / 0.03, 0.0, 1.0)
        * np.clip((mesh.points[:, 1] - 1.485) / 0.02, 0.0, 1.0)
    )
    mixed = mesh.normals * (1.0 - front)[:, None] + plain * front[:, None]
    return Mesh(mesh.points, mixed / np.linalg.norm(mixed, axis=1, keepdims=True), mesh.triangles)


def head(p: Array) -> Array:
    """Head and neck."""
    q = mirrored(p)
    body = _plain_face(q)
    brow = round_cone(q, (0.0, 1.626, 0.0725), (0.045, 1.624, 0.056), 0.011, 0.010)
    body = union(body, brow, 0.03)
    socket = ellipsoid(q, (EYE_CENTRE[0] - 0.002, EYE_CENTRE[1], 0.096), (0.0280, 0.0190, 0.0170))
    body = carved(body, socket, 0.018)
    nose = round_cone(q, (0.0, 1.594, 0.0785), (0.0, 1.5600, 0.0970), 0.0055, 0.0095)
    wing = sphere(q, (0.0075, 1.5570, 0.0900), 0.0066)
    body = union(body, union(nose, wing, 0.010), 0.016)
    lips = ellipsoid(q, (0.0, 1.5255, 0.0770), (0.022, 0.0120, 0.0090))
    body = union(body, lips, 0.016)
    ear = ellipsoid(_turned(q, (0.0775, 1.583, -0.014)), (0.0, 0.0, 0.0), (0.0085, 0.0300, 0.0185))
    bowl = ellipsoid(_turned(q, (0.0865, 1.585, -0.010)), (0.0, 0.0, 0.0), (0.0055, 0.0195, 0.0105))
    body = union(body, carved(ear, bowl, 0.005), 0.007)
    neck = common(loft(q, 1, _NECK), np.maximum(1.395 - q[:, 1], q[:, 1] - 1.56), 0.02)
    return union(body, neck, 0.018)


def _turned(q: Array, centre: tuple[float, float, float]) -> Array:
    """Axes of the ear: its front edge lies closer to the head than its back edge, its top leans back."""
    d = q - np.array(centre)
    turn, lean = 0.35, 0.18
    x = d[:, 0] * np.cos(turn) + d[:, 2] * np.sin(turn)
    z = -d[:, 0] * np.sin(turn) + d[:, 2] * np.cos(turn)
    y = d[:, 1] * np.cos(lean) - z * np.sin(lean)
    return np.column_stack([x, y, d[:, 1] * np.sin(lean) + z * np.cos(lean)])


def on_face(xy: Array) -> Array:
    """The points of the face seen from the front at (x, y), (N, 3), by sphere tracing along -Z."""
    points = np.column_stack([xy, np.full(len(xy), 0.16)])
    for _ in range(60):
        points[:, 2] -= 0.7 * head(points)
    return points
