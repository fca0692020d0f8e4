"""Small capitals of three by five dots, for labels in pictures."""

import numpy as np
from numpy.typing import NDArray

# Rows from the top, the left dot first, as octal digits.
_DOTS = {
    "A": "25755", "B": "65656", "C": "34443", "D": "65556", "E": "74647", "F": "74644", "G": "34553", "H": "55755",
    "I": "72227", "J": "11152", "K": "55655", "L": "44447", "M": "57755", "N": "65555", "O": "25552", "P": "65644",
    "Q": "25563", "R": "65655", "S": "34216", "T": "72222", "U": "55557", "V": "55552", "W": "55775", "X": "55255",
    "Y": "55222", "Z": "71247", "0": "75557", "1": "26227", "2": "61247", "3": "61216", "4": "55711", "5": "74616",
    "6": "34757", "7": "71244", "8": "75757", "9": "75716", "-": "00700", ".": "00002", "_": "00007", ",": "00024",
    "(": "24442", ")": "21112", "%": "51245", ":": "02020", "/": "11244",
}  # fmt: skip
_ROWS, _COLUMNS = 5, 3


def letter(image: NDArray[np.uint8], text: str, x: int, y: int, size: int, color: tuple[int, int, int]) -> None:
    """Write `text` into an RGB image with its top left corner at (x, y); what goes beyond the border is cut."""
    for character in text.upper():
        for row, dots in enumerate(_DOTS.get(character, "00000")):
            for column in range(_COLUMNS):
                if int(dots) >> (_COLUMNS - 1 - column) & 1:
                    top, left = y + row * size, x + column * size
                    image[max(top, 0) : top + size, max(left, 0) : left + size] = color
        x += (_COLUMNS + 1) * size
