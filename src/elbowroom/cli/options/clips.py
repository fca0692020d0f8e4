"""Options that name motion clips, the same in all commands that take some."""

from typing import TYPE_CHECKING, Annotated

import typer

from elbowroom.clips.style_names import PLAIN_NAME, check_style_name, name_and_share

if TYPE_CHECKING:
    from elbowroom.clips.motion_set import MotionSet
    from elbowroom.clips.told import Told


def _with_share(text: str) -> str:
    """The style as given; raises `InputError`."""
    name_and_share(text)
    return text


def _whole(text: str) -> str:
    """The style's name as given; raises `InputError`."""
    check_style_name(text)
    return text


Swing = Annotated[
    str | None,
    typer.Option("--swing", help="Walk as in this clip: FILE or FILE#CLIP (BVH, GLB, VRMA, X3D, USD).", metavar="CLIP"),
]
Style = Annotated[
    str,
    typer.Option(
        "--style",
        callback=_with_share,
        help="How to walk: plain, relaxed, brisk, careful, old or child; so much of it by NAME:SHARE, as old:0.5.",
    ),
]
StyleName = Annotated[
    str,
    typer.Option(
        "--style",
        callback=_whole,
        help="How to walk: plain, relaxed, brisk, careful, old or child; the page has a menu.",
    ),
]
Dodge = Annotated[
    list[str] | None,
    typer.Option("--dodge", help="Let the avatar learn this clip too; may be repeated.", metavar="CLIP"),
]
Unit = Annotated[str | None, typer.Option("--unit", help="Unit of the clips' files: m, cm, inch, cmu, or metres.")]
Up = Annotated[
    str | None,
    typer.Option("--up", help="The axis that points up in the place's file, or else in the clips': y, z, -x, ..."),
]
Fps = Annotated[float | None, typer.Option("--fps", help="Frames a second of the clips, whatever their files say.")]


def told_by(unit: str | None, up: str | None, fps: float | None) -> "Told":
    """What the options say about the files; raises `InputError`."""
    from elbowroom.clips.told import Told

    return Told(unit, up, fps)


def named_by(swing: str | None, dodge: list[str] | None) -> list[str]:
    """All clips that the options name."""
    return [*([] if swing is None else [swing]), *(dodge or ())]


def motions_by(swing: str | None, dodge: list[str] | None, told: "Told", style: str = PLAIN_NAME) -> "MotionSet":
    """The motions that the options ask for; raises `InputError`."""
    from elbowroom.clips.clip import Clip, motions_of
    from elbowroom.clips.style import style_named

    manner = style_named(style)
    clips = tuple(Clip.load(reference, told) for reference in dodge or ())
    return motions_of(None if swing is None else Clip.load(swing, told), clips, manner)
