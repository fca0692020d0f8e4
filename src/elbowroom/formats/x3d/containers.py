"""The field that a node of the XML encoding goes into where its element does not say so (`containerField`).

Source: the X3D Unified Object Model of ISO/IEC 19775-1.
"""

_FIELDS = {
    "appearance": ("Appearance",),
    "material": ("Material", "PhysicalMaterial", "UnlitMaterial", "TwoSidedMaterial"),
    "texture": ("ImageTexture", "PixelTexture", "MovieTexture", "MultiTexture", "ComposedTexture3D"),
    "textureTransform": ("TextureTransform", "MultiTextureTransform"),
    "geometry": (
        "Box",
        "Cone",
        "Cylinder",
        "Sphere",
        "ElevationGrid",
        "Extrusion",
        "IndexedFaceSet",
        "IndexedLineSet",
        "IndexedTriangleSet",
        "IndexedTriangleFanSet",
        "IndexedTriangleStripSet",
        "TriangleSet",
        "TriangleFanSet",
        "TriangleStripSet",
        "IndexedQuadSet",
        "QuadSet",
        "LineSet",
        "PointSet",
        "Text",
    ),
    "coord": ("Coordinate", "CoordinateDouble"),
    "color": ("Color", "ColorRGBA"),
    "normal": ("Normal",),
    "texCoord": ("TextureCoordinate", "TextureCoordinateGenerator", "MultiTextureCoordinate"),
    "fontStyle": ("FontStyle",),
    "displacers": ("HAnimDisplacer",),
    "motions": ("HAnimMotion",),
    "metadata": (
        "MetadataBoolean",
        "MetadataDouble",
        "MetadataFloat",
        "MetadataInteger",
        "MetadataSet",
        "MetadataString",
    ),
}

DEFAULT_FIELD = {kind: field for field, kinds in _FIELDS.items() for kind in kinds}


def default_field(kind: str, parent: str) -> str:
    """The field of a `parent` node that a node of this kind goes into."""
    if parent == "HAnimHumanoid" and kind == "HAnimJoint":
        return "skeleton"
    if parent == "MetadataSet" and kind.startswith("Metadata"):
        return "value"
    return DEFAULT_FIELD.get(kind, "children")
