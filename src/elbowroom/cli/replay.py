"""`elbowroom replay`: a recording repeated bit for bit, or shown on the page."""

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from elbowroom.cli.options.answers import Json, Quiet
from elbowroom.cli.options.arguments import check_arguments
from elbowroom.cli.options.recording import ItsAvatar, RecordingFile
from elbowroom.cli.play import serve_until_interrupted
from elbowroom.cli.telling.first_run import compile_first
from elbowroom.cli.telling.output import print_json, progress_bar
from elbowroom.cli.telling.spoken import said

if TYPE_CHECKING:
    from elbowroom.control.recordings.recording import Recording
    from elbowroom.control.recordings.replay import ReplayResult
    from elbowroom.server.stores.library import Library

EXAMPLES = "Examples:  elbowroom replay --show run.elbow  |  elbowroom replay run.elbow --avatar alice.vrm --json"
DIFFERENT = 1
_LIVE = "recorded live, where plans came when they were ready: the file shows what was shown, but is not computed again"


def replay(
    recording: RecordingFile,
    *,
    avatar: ItsAvatar = None,
    show: Annotated[bool, typer.Option("--show", help="Show what was recorded on the page, with a timeline.")] = False,
    port: Annotated[int, typer.Option(help="With --show: port; the next free one if busy, 0: any.")] = 8765,
    open_page: Annotated[bool, typer.Option("--open/--no-open", help="With --show: open a browser.")] = True,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Run the recorded commands again and compare every frame, bit for bit. Exit code 0: identical and whole, 1: not.

    With `--show` the recorded frames are shown on the page as they are, until Ctrl-C.

    Bit for bit holds for one processor that kernels are compiled for, and one version of what compiles them: where they
    are others, the last bits may differ, and this says so.
    """
    check_arguments(files=[recording, avatar], port=port)
    from elbowroom.control.recordings.recording import Recording
    from elbowroom.control.recordings.replay import replay as run_again

    recorded = Recording(recording)
    if show:
        library = partial(library_of, recorded, avatar)
        serve_until_interrupted(library, "127.0.0.1", port, open_page=open_page, query="replay")
        return
    humanoid = recorded.header.avatar.load(avatar)
    compile_first(quiet=quiet)
    with progress_bar(said("Replaying"), None, quiet) as bar:
        result = run_again(recorded, humanoid, lambda done: bar.move(done, f"{done} frames"))
    _report(recorded, result, json)
    raise typer.Exit(0 if result.identical and recorded.note is None else DIFFERENT)


def library_of(recorded: "Recording", avatar: Path | None) -> "Library":
    """The scene and the avatar of a recording, and the recording to begin with.

    Raises `InputError` where the recording shows nothing; whether it is whole is in its `note` then.
    """
    from elbowroom.body.loading.settings import LoadSettings
    from elbowroom.export.shown import ShownFrames
    from elbowroom.server.stores.library import Library
    from elbowroom.world.places.same_model import with_model_beside
    from elbowroom.world.scene import Scene

    ShownFrames.of(recorded)  # the page would wait for frames that never come
    header, path = recorded.header, str(recorded.path)
    told = header.avatar
    read = LoadSettings(told.bones or None, told.include_hair, told.height)
    scene = with_model_beside(Scene.from_dict(header.scene, path), recorded.path.parent)
    library = Library.open(scene, avatar, read=None if avatar is None else read, motions=header.motions)
    return replace(library, run=recorded.path)


def _report(recorded: "Recording", result: "ReplayResult", json: bool) -> None:
    elsewhere = _elsewhere(recorded)
    if json:
        found = result.difference
        report = {
            "recording": str(recorded.path),
            "identical": result.identical and recorded.note is None,
            "frames": result.frames,
            "seconds": result.seconds,
            "first_difference": None if found is None else vars(found),
            "note": recorded.note,
            "recorded_elsewhere": {key: before for key, (before, _) in elsewhere.items()},
            "here": {key: now for key, (_, now) in elsewhere.items()},
        }
        print_json(report)
        return
    if result.difference is not None:
        print(said("different from {0}", result.difference))
        print(_LIVE if recorded.header.live else _why(elsewhere))
    else:
        so_far = said("identical") if recorded.note is None else said("identical as far as it goes")
        print(said("{0}: {1} frames, {2} s", so_far, result.frames, f"{result.seconds:.1f}"))
    if recorded.note is not None:
        print(said("not whole: {0}", recorded.note))


def _elsewhere(recorded: "Recording") -> dict[str, tuple[str, str]]:
    """By what name the machine and the program of a recording differ from these: theirs and ours."""
    from elbowroom import __version__
    from elbowroom.control.recordings.recording import this_machine

    theirs = recorded.header.machine | {"elbowroom": recorded.header.version}
    ours = this_machine() | {"elbowroom": __version__}
    return {key: (value, ours.get(key, "none")) for key, value in theirs.items() if ours.get(key) != value}


def _why(elsewhere: dict[str, tuple[str, str]]) -> str:
    if not elsewhere:
        return "recorded by the same program on the same kind of processor: what it was recorded with has changed"
    others = ", ".join(f"{name} {before} (here {now})" for name, (before, now) in elsewhere.items())
    return f"recorded with {others}: bit for bit holds for the same ones alone, with others the last bits may differ"
