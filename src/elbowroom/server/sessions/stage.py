"""What one client sees: a walk, the clock it runs by, the command that is held. Time is an argument, in seconds."""

from collections import deque
from time import perf_counter

import numpy as np

from elbowroom.body.root import HEIGHT
from elbowroom.control.frame import Phase
from elbowroom.control.steering import steady
from elbowroom.control.things.loose import Thing
from elbowroom.planning.command import Command
from elbowroom.server.clip_walk import ClipWalk
from elbowroom.server.percentiles import percentiles
from elbowroom.server.schema.commands import ClockMessage, Input, Overlays, Push
from elbowroom.server.schema.menus import Settings
from elbowroom.server.schema.progress import Crossed, Nearest, Plan, Pushed, Status
from elbowroom.server.sessions.meter import Meter
from elbowroom.server.sessions.nearest import nearest
from elbowroom.server.sessions.punctuality import Punctuality
from elbowroom.server.sessions.reports import blocked_message, finite, group_reports, plan_message
from elbowroom.server.sessions.walk import Walk
from elbowroom.server.vmc.protocol import VmcMoment
from elbowroom.server.wire import pose_frame
from elbowroom.server.wire.pose_frame import PoseFrame

STEP = 1.0 / 60.0  # seconds of a single step

_LONGEST_GAP = 0.1  # seconds: what a late tick loses beyond this is not made up for
_TIMED = 300  # frames whose computing time is remembered
_PHASES = {phase: pose_frame.PHASES.index(phase.value) for phase in Phase}
_NO_CAPSULES = np.empty((0, 6), np.float32)


class Stage:
    """Advances a walk by a clock that can be paused, slowed down and stepped, and packs what there is to see."""

    def __init__(self, walk: Walk | ClipWalk, now: float, meter: Meter | None = None) -> None:
        """`meter` counts what all sessions of a server come to."""
        self.walk: Walk | ClipWalk = walk
        self.paused = False
        self.speed = 1.0
        self.overlays = Overlays()
        self.command = Command()
        self.revision = 1  # of the avatar
        self._told: dict[int, Thing] = {}
        self._epoch = 0
        self._index = 0
        self._acknowledged = 0
        self._advanced = now
        self._stepping = 0.0  # seconds of computing since the last frame was packed
        self._busy: deque[float] = deque(maxlen=_TIMED)
        self.punctuality = Punctuality(meter)

    def show(self, walk: Walk | ClipWalk) -> None:
        """Go on with another walk; the counters of crossings go on within a scene, and begin anew in another."""
        if walk.scene.name == self.walk.scene.name:
            walk.crossed, walk.stuck_times = self.walk.crossed, self.walk.stuck_times
        self.revision = (self.revision + (walk.avatar is not self.walk.avatar)) % 2**16
        self.walk = walk
        self._jump()

    def close(self) -> None:
        """Let the walk go, which is large: what ended a session may hold its parts until garbage is looked for."""
        del self.walk

    def reset(self) -> None:
        """Back to the start."""
        self.walk.reset()
        self._jump()

    def obey(self, message: Input, now: float) -> bool:
        """Hold what an input asks for; whether that is something else than before."""
        command = Command(message.forward, message.strafe, message.turn, message.direction, message.run)
        command = steady(self.command, command)
        changed = command != self.command
        self.command, self._acknowledged = command, message.seq
        if changed and not self.walk.heeds(command):
            self.punctuality.asked(now, command)
        return changed

    def release(self) -> None:
        """Hold nothing."""
        self.command = Command()
        self.push(Push(0, None))

    def push(self, message: Push) -> None:
        """Push something, or let go of it; raises `InputError`."""
        self.walk.push(message.obstacle, message.place)

    def pushed(self) -> list[Pushed]:
        """Where things are, of those that are elsewhere than was told last."""
        told = []
        for number, thing in self.walk.things.items():
            if self._told.get(number) is not thing:
                self._told[number] = thing
                x, y, z = thing.center.tolist()
                told.append(Pushed(number, self._epoch, self.walk.frame.time, (x, y, z), thing.yaw))
        return told

    def set_clock(self, message: ClockMessage) -> list[Crossed]:
        """Pause, go on, change speed, or take single steps."""
        if message.paused is not None:
            self.paused = message.paused
        if message.speed is not None:
            self.speed = message.speed
        if message.steps is None:
            return []
        self.paused = True
        return [event for _ in range(message.steps) for event in self._step(STEP)]

    def advance(self, now: float) -> list[Crossed]:
        """Go on to `now`, unless paused; what is worth telling."""
        elapsed = min(max(now - self._advanced, 0.0), _LONGEST_GAP)
        self._advanced = now
        if self.paused:
            return []
        events = self._step(elapsed * self.speed)
        self.punctuality.heard(now, self.walk.heeds)
        return events

    def frame(self, now: float) -> bytes:
        """The pose shown now, as it travels."""
        began = perf_counter()
        walk, frame = self.walk, self.walk.frame
        poser, root = walk.avatar.poser, frame.root
        posed = walk.node_pose()
        self._index += 1
        packed = pose_frame.pack(
            PoseFrame(
                flags=self._flags(),
                index=self._index % 2**32,
                time=now,
                sim_time=frame.time,
                acknowledged=self._acknowledged,
                epoch=self._epoch,
                avatar_revision=self.revision,
                phase=_PHASES[frame.phase],
                queue_fill=min(frame.fill, 255),
                x=root[0],
                y=root[HEIGHT],
                z=root[1],
                heading=root[2],
                forward=root[3],
                lateral=root[4],
                turn=root[5],
                gait=root[6],
                clearance=frame.clearance,
                hips_x=posed.hips[0],
                hips_y=posed.hips[1],
                hips_z=posed.hips[2],
                rotations=posed.rotations,
                capsules=poser.segments(frame.q, root)[0] if self.overlays.capsules else _NO_CAPSULES,
            )
        )
        self._busy.append(self._stepping + perf_counter() - began)
        self._stepping = 0.0
        return packed

    def moment(self) -> VmcMoment:
        """The pose shown now, for a puppet of the avatar elsewhere."""
        frame = self.walk.frame
        x, z, heading = frame.root[:3].tolist()
        return VmcMoment(frame.time, (x, float(frame.root[HEIGHT]), z), heading, self.walk.node_pose())

    @property
    def restless(self) -> bool:
        """Whether something may move though the avatar stands: it is told to go, or obstacles move by themselves."""
        moves = not self.walk.frame.command.idle or bool(len(self.walk.scene.obstacles.moving))
        moves = moves or any(thing.moves for thing in self.walk.things.values())
        return not self.paused and (moves or not self.command.idle)

    def status(self, now: float) -> Status:
        """The state in numbers."""
        walk, frame = self.walk, self.walk.frame
        plan = frame.plan
        groups = group_reports(plan)
        median, slow = percentiles(self._busy, 50, 95)
        return Status(
            time=now,
            sim_time=frame.time,
            phase=frame.phase.value,
            stuck=frame.stuck,
            root_kind="" if plan is None else plan.root.kind.value,
            plan_status="" if plan is None else plan.local.status.value,
            groups=groups,
            plans=walk.plans,
            plans_failed=walk.plans_failed,
            checks=sum(group.checks for group in groups),
            planning_ms=sum(group.ms for group in groups),
            frame_ms_p50=1e3 * median,
            frame_ms_p95=1e3 * slow,
            late_ms_p99=self.punctuality.late_ms,
            answer_ms=self.punctuality.answer_ms,
            late_plans=walk.late_plans,
            look_ahead=0.0 if plan is None else plan.root.path.horizon * plan.root.path.interval,
            queue_fill=frame.fill,
            queue_size=walk.settings.queue_size,
            crossed=walk.crossed,
            stuck_times=walk.stuck_times,
            clearance=finite(frame.clearance),
            nearest=self._nearest() if self.overlays.capsules else None,
            blocked=blocked_message(plan, walk.surroundings.obstacles.names),
        )

    def plan(self) -> Plan:
        """What is planned ahead."""
        return plan_message(self.walk.frame, self.walk.avatar)

    def settings(self) -> Settings:
        """The choices in force."""
        walk = self.walk
        return Settings(
            scene=walk.scene.name,
            avatar=walk.avatar.id,
            planner=walk.settings.planner,
            queue_size=walk.settings.queue_size,
            assist=walk.settings.assist,
            walk_speed=walk.settings.walk_speed,
            style=walk.settings.style,
            paused=self.paused,
            speed=self.speed,
            capsules=self.overlays.capsules,
            plan=self.overlays.plan,
            clip=walk.stored.id if isinstance(walk, ClipWalk) else "",
            clip_as_planned=isinstance(walk, ClipWalk) and walk.as_planned,
        )

    def _step(self, dt: float) -> list[Crossed]:
        began = perf_counter()
        rounds = self.walk.rounds
        seconds = self.walk.step(self.command, dt)
        if self.walk.rounds != rounds:
            self._jump()
        self._stepping += perf_counter() - began
        if seconds is None:
            return []
        return [Crossed(seconds, self.walk.stuck_since_start, self.walk.crossed)]

    def _jump(self) -> None:
        self._epoch = (self._epoch + 1) % 2**16
        self._told.clear()
        self.punctuality.begin()

    def _flags(self) -> int:
        walk, bits = self.walk, pose_frame.FLAGS
        return (
            pose_frame.feet_bits(walk.frame.contacts)
            | bits["stuck"] * walk.frame.stuck
            | bits["touching"] * walk.frame.touching
            | bits["paused"] * self.paused
            | bits["assist"] * walk.settings.assist
            | bits["finished"] * walk.finished
        )

    def _nearest(self) -> Nearest | None:
        walk, frame = self.walk, self.walk.frame
        capsules = walk.avatar.humanoid.capsules
        segments = walk.avatar.poser.segments(frame.q, frame.root)[0]
        return nearest(segments, capsules.radii, capsules.names, walk.surroundings, frame.time)
