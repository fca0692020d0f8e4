"""A run as one HTML file that plays by itself: scripts, scene, avatar and motion in it, nothing is fetched."""

import base64
import gzip
import html
from pathlib import Path
from typing import NamedTuple

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.loading.permissions import Use
from elbowroom.control.recordings.recording import Recording
from elbowroom.errors import InputError
from elbowroom.server.sessions.reports import avatar_message, scene_message
from elbowroom.server.standalone.frames import posed_frames
from elbowroom.server.standalone.packed_run import PackedRun, pack_run, read_run
from elbowroom.server.stores.avatar_store import StoredAvatar
from elbowroom.server.wire.codec import plain

MOST_AVATAR = 24 * 2**20  # bytes of an avatar's file that is put in
_CLIENT = Path(__file__).parents[2] / "client" / "player"
_NOT_READ = b'"KHR_draco_mesh_compression"'  # compressed in a way that the player does not decode

_PAGE = """<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="generator" content="Elbowroom">
<title>{title} · Elbowroom</title>
<style>{style}</style>
<body>
<script type="application/octet-stream" id="run">{run}</script>
<script type="application/octet-stream" id="player">{player}</script>
<script>
const opened = async (id) => {{
  const packed = Uint8Array.from(atob(document.getElementById(id).textContent), (c) => c.charCodeAt(0));
  return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
}};
(async () => {{
  window.elbowroomRun = await opened("run");
  const script = document.createElement("script");
  script.textContent = new TextDecoder().decode(await opened("player"));
  document.body.append(script);
}})();
</script>
"""


class Page(NamedTuple):
    """A page, and what there is to say about it."""

    html: str
    notes: tuple[str, ...]


def page_of_recording(recording: Recording, humanoid: Humanoid, name: str) -> Page:
    """What a recording shows, on the avatar that it was made with; raises `InputError`."""
    stored = StoredAvatar("avatar", humanoid, None)
    glb, notes = _embedded(stored)
    head = {
        "name": name,
        "planner": recording.header.settings.planner,
        "scene": plain(scene_message(recording.scene())),
        "avatar": plain(avatar_message(stored, 0)),
        "note": recording.note or "",
    }
    return _page(PackedRun(head, b"".join(posed_frames(recording, humanoid)), glb), notes)


def page_of_sent(data: bytes, avatar: StoredAvatar) -> Page:
    """A run that a page has sent, on an avatar of this server; raises `InputError`."""
    head, frames = read_run(data)
    glb, notes = _embedded(avatar)
    if head["scene"].get("model"):
        notes = (*notes, "the model of the place is left out")
    return _page(PackedRun({**head, "avatar": plain(avatar_message(avatar, 0))}, frames, glb), notes)


def _embedded(avatar: StoredAvatar) -> tuple[bytes | None, tuple[str, ...]]:
    """The avatar's file where it may be handed on and can be read, and what there is to say about it."""
    humanoid = avatar.humanoid
    glb = avatar.glb.read_bytes() if avatar.glb is not None and avatar.glb.is_file() else humanoid.glb
    refusal = humanoid.meta.permissions.refusal(Use.EMBED)
    if glb is None or humanoid.rig is None:
        return None, ("the avatar has no file: its capsules are shown",)
    if refusal is not None:
        return None, (f"{refusal}: its capsules are shown",)
    if len(glb) > MOST_AVATAR or _NOT_READ in glb[: 2**20]:
        return None, ("the avatar's file is too large, or compressed by Draco: its capsules are shown",)
    return glb, ()


def _page(run: PackedRun, notes: tuple[str, ...]) -> Page:
    scene = {**run.head["scene"], "model": None}
    avatar = {**run.head["avatar"], "url": None, "drawCapsules": run.glb is None}
    packed = pack_run(run._replace(head={**run.head, "scene": scene, "avatar": avatar}))
    return Page(
        _PAGE.format(
            title=html.escape(str(scene.get("title", "")) or str(run.head["name"])),
            style=_style(),
            run=_text(packed),
            player=_text(_player()),
        ),
        notes,
    )


def _text(data: bytes) -> str:
    return base64.b64encode(gzip.compress(data, 9, mtime=0)).decode()


def _player() -> bytes:
    return _built("player.js")


def _style() -> str:
    return _built("player.css").decode().replace("</", "<\\/")


def _built(name: str) -> bytes:
    try:
        return (_CLIENT / name).read_bytes()
    except OSError:
        raise InputError(f"{name}: the player is not built; run `make env` in a checkout, or install again") from None
