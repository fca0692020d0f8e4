"""The messages of a live session: the one source from which the TypeScript types are generated.

They travel over one WebSocket as JSON text, `{"type": "input", ...}`; poses travel from the server as binary frames
(`pose_frame`).
"""

from elbowroom.server.schema.commands import ClockMessage, Configure, Goto, Input, Overlays, Ping, Push, Reset
from elbowroom.server.schema.menus import Hello, Settings
from elbowroom.server.schema.picture import AvatarMessage, ClipMessage, SceneMessage
from elbowroom.server.schema.progress import Crossed, Going, Loading, Notice, Plan, Pong, Pushed, Status

ClientMessage = Input | Configure | ClockMessage | Reset | Goto | Push | Overlays | Ping
ServerMessage = (
    Hello
    | Settings
    | SceneMessage
    | AvatarMessage
    | ClipMessage
    | Status
    | Plan
    | Loading
    | Crossed
    | Going
    | Pushed
    | Notice
    | Pong
)
