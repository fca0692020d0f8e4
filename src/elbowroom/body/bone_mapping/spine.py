"""The spine: the nodes between hips and neck, however many there are, spread over the three spine bones of VRM."""

import re
from collections.abc import Mapping

from elbowroom.body.bone_mapping.file_nodes import FileNodes
from elbowroom.body.bone_mapping.spelling import names_no_body, simplified
from elbowroom.body.bones import SPINE

_WORD = re.compile(r"(spine|chest|upperchest|torso|abdomen|waist|lowerback)\d*")


def spine_bones(nodes: FileNodes, bones: Mapping[str, int], named: frozenset[int]) -> dict[str, int]:
    """spine, chest and upperChest as far as there are nodes for them; nothing where head and hips are not in one line.

    Nodes whose names say so (`named`, or the words of the name) go first; else all up to the shoulders count.
    """
    top = bones.get("neck", bones.get("head"))
    if top is None or "hips" not in bones:
        return {}
    above = nodes.ancestors(top)
    if bones["hips"] in above:
        between = above[: above.index(bones["hips"])][::-1]
        shared = -1
    else:  # the hips may hang on the first bone of the trunk
        shared = next((node for node in nodes.ancestors(bones["hips"]) if node in above), -1)
        between = above[: above.index(shared) + 1][::-1] if shared >= 0 else []
    spine = [node for node in between if node in named or _WORD.fullmatch(simplified(nodes.names[node]))]
    if shared >= 0 and shared not in spine:
        return {}
    if not spine and between:
        body = [node for node in between if not names_no_body(nodes.names[node])]
        spine = _up_to_the_shoulders(nodes, bones, body)
    if len(spine) > len(SPINE):
        spine = [spine[0], spine[len(spine) // 2], spine[-1]]
    return dict(zip(SPINE, spine, strict=False))


def _up_to_the_shoulders(nodes: FileNodes, bones: Mapping[str, int], between: list[int]) -> list[int]:
    arms = [bones[name] for name in ("leftShoulder", "leftUpperArm") if name in bones]
    carried = set(nodes.ancestors(arms[0])) if arms else set()
    carrying = [node for node in between if node in carried]
    if carrying or not arms:
        return carrying or between
    shoulders = nodes.positions[arms[0], 1]
    return [node for node in between if nodes.positions[node, 1] <= shoulders] or between[:1]
