"""What is shown of a node: the nodes inside it that a viewer would draw."""

from elbowroom.formats.x3d.model import Node, Nodes


def shown_parts(node: Node) -> Nodes:
    """The nodes in `node` that are shown: children, the chosen one of a Switch, the finest level of an LOD."""
    match node.kind:
        case "HAnimHumanoid":
            return (node.nodes("skeleton") or node.nodes("humanoidBody")) + node.nodes("skin")
        case "Switch":
            choices = node.nodes("children") or node.nodes("choice")
            chosen = int(node.number("whichChoice", -1.0))
            return choices[chosen : chosen + 1] if 0 <= chosen < len(choices) else []
        case "LOD":
            return (node.nodes("children") or node.nodes("level"))[:1]
        case "Shape" | "Script":
            return []
    return node.nodes("children")
