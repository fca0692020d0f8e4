"""Recorded runs for a page to play: read and posed in a process of their own, then sent as they are."""

import asyncio
import json
import struct
from dataclasses import asdict
from pathlib import Path
from typing import NamedTuple

from starlette.responses import Response

from elbowroom.control.recordings.avatar_reference import AvatarReference
from elbowroom.errors import InputError
from elbowroom.server.apart.process import run_apart
from elbowroom.server.entrance.in_pieces import InPieces
from elbowroom.server.schema.runs import Run
from elbowroom.server.sessions.reports import avatar_message, scene_message
from elbowroom.server.standalone.frames import PosedRun
from elbowroom.server.stores.avatar_store import STOCK, StoredAvatar
from elbowroom.server.stores.library import Library
from elbowroom.server.wire.codec import plain
from elbowroom.world.places.same_model import shown_as_known
from elbowroom.world.scene import Scene

_LENGTH = struct.Struct("<I")


class ShownRun(NamedTuple):
    """A run as a page takes it."""

    run: Run
    frames: bytes  # one pose frame after the other


async def shown_run(library: Library, file: Path, name: str) -> ShownRun:
    """A recording, posed on the avatar that it was made with where this server has it; `name` is what to call it.

    Raises `InputError`, `ApartError` and `FullDiskError` as `run_apart`.
    """
    known = await asyncio.to_thread(_references, library)
    posed = PosedRun(*await run_apart("pose_run", name, str(file), name, json.dumps(known)))
    return await asyncio.to_thread(_told, library, name, posed)


def run_response(shown: ShownRun) -> Response:
    """The answer to a page."""
    head = json.dumps(plain(shown.run), separators=(",", ":"), allow_nan=False).encode()
    return InPieces(_LENGTH.pack(len(head)) + head + shown.frames, media_type="application/octet-stream")


def _references(library: Library) -> dict[str, dict[str, object]]:
    """How to find the files of the avatars that the server was given, by their ids."""
    found = {}
    for avatar in library.avatars.lasting():
        try:
            reference = AvatarReference.of(avatar.humanoid)
        except InputError:  # its file is gone
            continue
        if reference.path:
            found[avatar.id] = asdict(reference)
    return found


def _told(library: Library, name: str, posed: PosedRun) -> ShownRun:
    avatar: StoredAvatar = library.avatars.get(posed.avatar or STOCK)
    size = len(posed.frames) // max(posed.count, 1)
    run = Run(
        name=name,
        scene=scene_message(shown_as_known(Scene.from_dict(posed.scene, name), library.scenes.values())),
        avatar=avatar_message(avatar, 0),
        planner=posed.planner,
        stand_in=posed.stand_in,
        note=posed.note,
        frames=posed.count,
        frame_bytes=size,
    )
    return ShownRun(run, posed.frames)
