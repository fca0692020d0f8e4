"""The colours of the figure, as linear RGB."""

from make_stock_avatar.vrm import Material


def _srgb(code: str) -> tuple[float, float, float]:
    """Linear RGB of an sRGB hexadecimal colour (IEC 61966-2-1)."""
    values = (int(code[i : i + 2], 16) / 255.0 for i in (0, 2, 4))
    red, green, blue = (v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4 for v in values)
    return round(red, 5), round(green, 5), round(blue, 5)


SKIN = Material("Skin", _srgb("f0c3a4"), 0.75, glow=0.16)
LIDS = Material("Lids", _srgb("ecbc9c"), 0.75, glow=0.16, double_sided=True)
HAIR = Material("Hair", _srgb("5a3a2a"), 0.58)
SHIRT = Material("Shirt", _srgb("2f8f8b"), 0.9)
TRIM = Material("Trim", _srgb("f3ead8"), 0.9)
TROUSERS = Material("Trousers", _srgb("35415c"), 0.92)
TURN_UPS = Material("TurnUps", _srgb("5b6d92"), 0.92)
SHOES = Material("Shoes", _srgb("e5673f"), 0.75)
SOLES = Material("Soles", _srgb("f6f1e6"), 0.85)
EYES = Material("Eyes", (1.0, 1.0, 1.0), 0.25)
LASHES = Material("Lashes", _srgb("33221b"), 0.8, double_sided=True)
BROWS = Material("Brows", _srgb("4b3023"), 0.8, double_sided=True)
MOUTH = Material("Mouth", _srgb("8c3b3a"), 0.7, double_sided=True)
TEETH = Material("Teeth", _srgb("f7f3ec"), 0.5, double_sided=True)

CREASE = (0.78, 0.42, 0.36)  # skin in deep creases, as a factor
SHADOW = (0.25, 0.27, 0.36)  # cloth in deep creases, as a factor
