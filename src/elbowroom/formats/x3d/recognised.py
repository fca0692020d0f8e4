"""Which files are X3D or VRML, told without what reads them."""

SUFFIXES = (".x3d", ".x3dv", ".wrl", ".x3dz", ".x3dvz", ".wrz", ".x3d.gz", ".x3dv.gz", ".wrl.gz")
GZIP = b"\x1f\x8b"
COLLADA = b"<COLLADA"  # another kind of model, in XML as well
UTF16 = (b"\xff\xfe", b"\xfe\xff")


def is_x3d(data: bytes) -> bool:
    """Whether these bytes begin like X3D or VRML, maybe packed with gzip."""
    head = data[:64].lstrip(b"\xef\xbb\xbf \t\r\n")
    if COLLADA in data[:4096]:
        return False
    return head.startswith((GZIP, b"#VRML", b"#X3D", b"<?xml", b"<X3D", b"<!")) or data[:2] in UTF16
