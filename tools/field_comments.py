"""For the API reference: the comment behind a field says what it holds, its shape and its unit, so it is shown there.

`time: float  # seconds since the start` stands in the reference as the field `time` with that sentence. A field that
has a docstring keeps it.
"""

import io
import tokenize
from functools import cache
from pathlib import Path
from typing import Any

import griffe


class FieldComments(griffe.Extension):
    """Gives every field without a docstring the comment that stands behind it."""

    def on_class_members(self, *, cls: griffe.Class, **_: Any) -> None:
        """Called by griffe for every class that it has read."""
        for field in cls.attributes.values():
            if field.docstring is None and field.lineno is not None and isinstance(field.filepath, Path):
                comment = comments(field.filepath).get(field.endlineno or field.lineno)
                if comment:
                    field.docstring = griffe.Docstring(comment, lineno=field.lineno, parent=field)


@cache
def comments(path: Path) -> dict[int, str]:
    """The comments of a file that stand behind code, by line."""
    tokens = tokenize.generate_tokens(io.StringIO(path.read_text("utf-8")).readline)
    return {
        token.start[0]: token.string.lstrip("# ").strip()
        for token in tokens
        if token.type == tokenize.COMMENT and token.line[: token.start[1]].strip()
    }
