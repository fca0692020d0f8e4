"""H-Anim files made on the spot whose figures move: interpolators and routes behind those of `hanim_builder`."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hanim_builder import NAMES_1, NAMES_2, HanimRecipe, build_hanim

Floats = NDArray[np.float64]
Moves = dict[tuple[str, str], Floats]  # bone, or "" for the figure, and field -> values (K, 3) or (K, 4)

CYCLE = 2.0  # seconds
_KINDS = {"rotation": "OrientationInterpolator", "translation": "PositionInterpolator"}


def build_moving(recipe: HanimRecipe, moves: Moves) -> bytes:
    """A file after the recipe, moved evenly over `CYCLE` seconds by one TimeSensor, `Clock`."""
    lines, routes = [_node(recipe, "Clock", "TimeSensor", cycleInterval=np.array([CYCLE]))], []
    names = NAMES_1 if recipe.version == "1.1" else NAMES_2
    for number, ((bone, field), values) in enumerate(moves.items()):
        own, moved = f"Move{number}", recipe.prefix + names[bone] if bone else "Figure"
        keys = np.linspace(0.0, 1.0, len(values))
        lines.append(_node(recipe, own, _KINDS[field], key=keys, keyValue=values))
        routes.append(("Clock", "fraction_changed", own, "set_fraction"))
        routes.append((own, "value_changed", moved, f"set_{field}"))
    lines += [_route(recipe, *route) for route in routes]
    text = build_hanim(replace(recipe, packed=False)).decode()
    more = "\n".join(lines) + "\n"
    return (text.replace("</Scene>", more + "</Scene>") if recipe.encoding == "xml" else text + more).encode()


def _node(recipe: HanimRecipe, name: str, kind: str, **fields: Floats) -> str:
    told = {field: " ".join(f"{value:.9g}" for value in np.ravel(values)) for field, values in fields.items()}
    if recipe.encoding == "xml":
        return f'<{kind} DEF="{name}" ' + " ".join(f'{field}="{text}"' for field, text in told.items()) + "/>"
    listed = {field: f"[ {text} ]" if field.startswith("key") else text for field, text in told.items()}
    return f"DEF {name} {kind} {{ {' '.join(f'{field} {text}' for field, text in listed.items())} }}"


def _route(recipe: HanimRecipe, source: str, output: str, target: str, into: str) -> str:
    if recipe.encoding == "xml":
        return f'<ROUTE fromNode="{source}" fromField="{output}" toNode="{target}" toField="{into}"/>'
    return f"ROUTE {source}.{output} TO {target}.{into}"
