"""The control loop of the paper's Figure 4: plan, play, reset."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import RootState
from elbowroom.clips.motion_set import STOCK, MotionSet
from elbowroom.control import steering
from elbowroom.control.feet.in_step import in_step
from elbowroom.control.frame import Frame, Phase
from elbowroom.control.handed_over import is_number
from elbowroom.control.journey import Journey
from elbowroom.control.key_frame_queue import KeyFrameQueue, Playback
from elbowroom.control.made_of import check_made_of
from elbowroom.control.others.neighbour import Neighbour, Walker
from elbowroom.control.others.passing import expected, way_made
from elbowroom.control.others.prediction import neighbour, slimmer
from elbowroom.control.plans.desk import ImmediateDesk
from elbowroom.control.plans.errands import Errands
from elbowroom.control.plans.grounds import Grounds
from elbowroom.control.plans.last_plan import LastPlan
from elbowroom.control.plans.lookahead import STOCK_LOOKAHEAD, Lookahead
from elbowroom.control.plans.planning_scene import PlanningScene
from elbowroom.control.plans.rehearsal import Held
from elbowroom.control.plans.wayfinder import Answer, Question
from elbowroom.control.settings import ControlSettings
from elbowroom.control.shown.body_check import BodyCheck, configuration
from elbowroom.control.shown.showing import Showing
from elbowroom.control.things.loose import Hand, Thing
from elbowroom.control.things.pushing import Pushing
from elbowroom.errors import InputError
from elbowroom.planning.command import Command, changed
from elbowroom.planning.model.fitted_swing import fitted
from elbowroom.planning.motion import MotionQuery
from elbowroom.planning.names import DEFAULT_PLANNER
from elbowroom.planning.navigation.navigator import Navigator
from elbowroom.planning.navigation.way import Place, Spot, Way
from elbowroom.planning.stillness import is_still
from elbowroom.world.obstacles.tracks.moving import Moving
from elbowroom.world.scene import Scene, on_ground

FORWARD = Command(forward=1.0)
LONGEST_TURN = 1 / 40  # seconds: a longer step is played in several turns, each of them checked
LONGEST_STEP = 60.0  # seconds
_STANDING_RATE = 1e-6  # of the pace of the plan: slower is no playing
_LEAVING = 0.015  # metres that others are taken to be away by who touches them
_RESERVE = 2.4  # seconds of motion that are kept for late plans


class Controller:
    """Turns commands into poses that touch nothing, one `step` at a time.

    It reads no clock: time is the sum of the `dt` it was given, chance comes from the seed, so the same steps give the
    same frames bit for bit. It owns what lives: the queue, the planners with what they remember, the pose.

    Planning is done at a desk, at once by default. A desk that takes its time is asked for plans that start a little
    later; meanwhile what is in the queue is played, and slows down to a stand before it ends.
    """

    def __init__(
        self,
        humanoid: Humanoid,
        scene: Scene,
        *,
        planner: str = DEFAULT_PLANNER,
        seed: int = 0,
        assist: bool = True,
        start: RootState | None = None,
        motions: MotionSet = STOCK,
        ahead: Lookahead = STOCK_LOOKAHEAD,
    ) -> None:
        """Stand the humanoid at the scene's start, or at `start`.

        It walks as `motions` say, and evades by them (`motions_of` makes them of clips). Plans lead so far `ahead`.

        Raises `InputError` for settings out of range and where the standing avatar touches an obstacle.
        """
        check_made_of(humanoid, scene, motions)
        self.humanoid = humanoid  # who walks
        self.scene = scene  # where
        self.settings = ControlSettings(planner, ahead.queue_size, ahead.interval, seed, assist)  # what it was told
        self.start = scene.start if start is None else start  # where it stands after a reset
        self.motions = motions  # how it walks and evades
        self._errands = Errands(ahead.desk or ImmediateDesk())
        self._fitted = fitted(motions, humanoid)
        self._grounds = Grounds(humanoid, scene, self.settings, self._fitted)
        self._around = self._grounds.walked  # where it is checked and planned for
        self.journey: Journey | None = None  # the walk to a place that goes on, or has ended last
        self._begin()

    def reset(self, start: RootState | None = None) -> None:
        """Back to the start, as if newly made, or to another `start` from now on.

        Raises `InputError` where the standing avatar touches an obstacle there, and goes on as it was.
        """
        anew, start = bool(self._pushing.things), start or self.start
        grounds = Grounds(self.humanoid, self.scene, self.settings, self._fitted) if anew else self._grounds
        self._standing_at(start, grounds.walked)
        self.start, self.journey, self._grounds = start, None, grounds
        self._errands.forget()
        grounds.forget()
        self._settle_in(grounds.walked)
        self._begin()
        self._pushing.rest(self._check, self._queue.time)

    def _settle_in(self, around: PlanningScene) -> None:
        """Check and plan there from now on; what moves about it goes on as it did."""
        if around is not self._around:
            before, self._around = self._check, around
            self._check.others, self._check.told, self._check.loose = before.others, before.told, before.loose
            self._showing.go_among(around)

    @property
    def _climbs(self) -> bool:
        """Whether it is on the ground that it climbs."""
        return self._around is not self._grounds.walked

    @property
    def _check(self) -> BodyCheck:
        return self._around.check

    def prepare(self) -> None:
        """Make the planners now, in the caller's thread, so that the first plan need not wait for that."""
        self._around.planners.make()

    @property
    def navigator(self) -> Navigator:
        """Finds ways in the scene, for `goto` and for who wants to find them in another thread."""
        return self._grounds.walked.navigator

    def goto(self, place: Place | Spot, pace: Command = FORWARD) -> Journey:
        """Go to a place (x, z) or (x, height, z), with the following steps; a command that is not idle takes over.

        Without a height it is on the floor there that a way leads to, the avatar's own if it can be. `pace` says how
        fast, by its `forward` and `run`. Raises `NoWayError` where no way leads there.
        """
        here = float(self.root.x), float(self.root.height), float(self.root.z)
        wanted = steering.checked(pace)  # before a way is sought
        return self.set_out(self.navigator.find(here, place), wanted)

    def set_out(self, way: Way, pace: Command = FORWARD) -> Journey:
        """Go along a way that was found before."""
        self.journey = Journey(self.navigator, way, steering.checked(pace))
        return self.journey

    @property
    def things(self) -> Mapping[int, Thing]:
        """What was pushed since the start, by its number among the scene's standing obstacles."""
        return self._pushing.things

    @property
    def surroundings(self) -> Scene:
        """The scene as it is now: what was pushed is where it is."""
        return self._pushing.scene_at(self._queue.time)

    @property
    def hand(self) -> Hand | None:
        """What is pushed now, and where to."""
        return self._pushing.hand

    def push(self, number: int, place: tuple[float, float]) -> None:
        """Push a standing obstacle over the ground, with the following steps, until it is at a place (x, z).

        It is told by its number in the scene, upright and small, moves at up to `loose.FASTEST`, and stops before the
        body that is shown. It stays where it is left, until `reset`. Raises `InputError` for what cannot be pushed.
        """
        standing = self._pushing.take(Hand(number, place), self._check, self._shown)
        if standing is not None:
            climbs = self._climbs
            self._grounds = Grounds(self.humanoid, standing, self.settings, self._fitted)
            self._settle_in(self._grounds.around(climbs=climbs))
            self._pushing.rest(self._check, self._queue.time)

    def let_go(self) -> None:
        """Push nothing any more."""
        self._pushing.let_go()

    def _begin(self) -> None:
        self._pushing = Pushing(self.scene)
        self._queue = KeyFrameQueue(self.settings.queue_size, self.settings.interval)
        self._errands.begin()
        self._last = LastPlan()
        self._wish = Command()  # what was wanted last, by the user or on a journey
        self._flow = self._next = Phase.PLAN  # what the last turn did, and what the next one is to do
        self._blocked = False  # no way on was found and nothing is left to play, or what is shown goes back
        self._vain = False  # what was planned from a held pose could not be shown, where plans are dear
        self._halting = False  # what is left to play is not wanted any more: it slows down to a stand
        self._resting = False  # the plan changes nothing: one stands on as one stood
        self.late_plans = 0  # that could not be shown any more when they came
        self._showing = self._standing_at(self.start, self._around)

    def _standing_at(self, start: RootState, around: PlanningScene) -> Showing:
        if not isinstance(start, RootState) or not all(map(is_number, start)):
            raise InputError(f"start: {start} is no RootState of finite numbers, such as RootState(x=1.0, z=2.0)")
        root = on_ground(self.scene, start)._replace(forward=0.0, lateral=0.0, turn=0.0, climb=0.0).as_array()
        showing = Showing(around, root, assist=self.settings.assist)
        if showing.clearance < 0.0:
            place = f"x {root[0]:.3g}, z {root[1]:.3g}"
            raise InputError(f"scene {self.scene.name}, start: {self.humanoid.name} touches an obstacle at {place}")
        return showing

    @property
    def _shown(self) -> Playback:
        return self._showing.pose

    @property
    def root(self) -> RootState:
        """The root state that is shown."""
        return RootState.of(self._shown.root)

    @property
    def others(self) -> Sequence[Neighbour]:
        """Other avatars, as they say that they will move (`prediction`); may change with every step."""
        return self._check.others

    @others.setter
    def others(self, neighbours: Sequence[Neighbour]) -> None:
        self._check.others = tuple(neighbours)

    def prediction(self) -> Neighbour:
        """Where this avatar will be, as far as key frames are known and then straight on: for others' `others`.

        From then on it shows nothing that would touch who goes by that.
        """
        onward = self._last.command.forward > 0.0
        model, walker = self._check.model, self._walker()
        told = neighbour(self.humanoid, model, walker, self._shown, self._queue, self._showing.follow, onward=onward)
        self._check.told = told
        return told

    def _walker(self, command: Command | None = None) -> Walker:
        """Where this avatar is, and where to it is asked to go, with what was planned for last or with a command."""
        if self._wish.idle:
            return Walker(self._shown.root[:2], np.zeros(2))
        wanted = steering.direction(command or self._last.command, self._shown.root[2])
        travel = self._last.travel
        if travel is not None and not (command and changed(self._last.command, command)):
            wanted = np.array([math.sin(travel), math.cos(travel)])
        return Walker(self._shown.root[:2], wanted)

    @property
    def stands(self) -> bool:
        """Whether the root stands still."""
        return is_still(self._shown.root[3:6])

    @property
    def phase(self) -> Phase:
        """The flow that the last turn took."""
        return self._flow

    @property
    def assist(self) -> bool:
        """Whether upper-body motion is planned; off, the canned walk is shown, touching what it touches."""
        return self._showing.assist

    @assist.setter
    def assist(self, wanted: bool) -> None:
        if wanted == self.assist:
            return
        self._showing.assist = wanted
        self._next, self._resting = Phase.RESET, False
        if wanted and self._showing.leave_touch():
            self._clear()

    def step(self, command: Command, dt: float) -> Frame:
        """Go on by `dt` seconds under `command` and say what to show.

        A step longer than `LONGEST_TURN` is played in equal turns; `dt` 0 changes nothing. Raises `InputError` if a
        component of the command is no number, or `dt` is negative or longer than `LONGEST_STEP`.
        """
        wanted = steering.checked(command)
        if not (is_number(dt) and 0.0 <= dt <= LONGEST_STEP):
            raise InputError(f"dt: {dt} is not between 0 and {LONGEST_STEP:g} seconds")
        wanted = self._on_the_way(wanted, dt)
        turns = math.ceil(dt / LONGEST_TURN)
        flows = [self._turn(self._aside(wanted), dt / turns) for _ in range(turns)]
        self._flow = next((flow for flow in (Phase.RESET, Phase.PLAN) if flow in flows), Phase.PLAY)
        return self._frame(wanted)

    @property
    def _going(self) -> Journey | None:
        """The journey that it is on."""
        return self.journey if self.journey is not None and self.journey.walking else None

    def _on_the_way(self, command: Command, dt: float) -> Command:
        """The user's command, or where nothing is wanted, what the journey asks for."""
        going = self._going
        if going is None or dt <= 0.0:
            return command
        if not command.idle:
            going.take_over()
            return command
        return going.command(self.root, dt, stuck=self._no_way_on, plans=self._last.number)

    def _aside(self, command: Command) -> Command:
        """What to do under a command: a step aside, where nothing is wanted and others want to pass."""
        self._wish = command
        if not command.idle or not self.others or not self.assist:
            return command
        shown, free_map = self._shown, self._around.free_map
        body = self._check.body(shown.root, shown.upper)
        aside = way_made(self._walker(), float(shown.root[2]), body, self.others, free_map)
        return replace(aside, led=command.led, may_climb=command.may_climb)

    def _turn(self, command: Command, dt: float) -> Phase:
        self._move_things(dt)
        self._take_plan(command)
        self._errands.supersede(command)
        flow = self._choose_flow(command)
        if flow is Phase.RESET:
            self._reset_queue()
        if flow is not Phase.PLAY:
            self._plan(command, at_once=flow is Phase.RESET or changed(self._last.command, command))
        self._play(dt)
        if self._is_stuck(command):
            self._showing.wait(dt, on_the_way=command.led)
        return flow

    def _move_things(self, dt: float) -> None:
        """What is loose goes on; who rests looks up."""
        self._pushing.advance(self._check, self._shown, self._queue.time, dt)
        if self._resting and self._pushing.moves:
            self._resting, self._next = False, Phase.PLAN

    def _choose_flow(self, command: Command) -> Phase:
        """Figure 4 (b): which flow this turn takes."""
        if self._errands.busy or (self._resting and command.idle) or self._showing.goes_back:
            return Phase.PLAY
        if steering.overturned(self._last.command, command):
            return Phase.RESET
        if self._next is Phase.RESET:
            return Phase.PLAY if self._waits(command) else Phase.RESET
        if self._next is Phase.PLAN or self._queue.consumed > 1.0 or changed(self._last.command, command):
            return Phase.PLAN
        return Phase.PLAY

    def _waits(self, command: Command) -> bool:
        """Whether a plan for the same wish, less than an interval ago, found no way on, or none that could be shown."""
        if not (self._blocked or self._vain) or changed(self._last.command, command):
            return False
        return self._last.is_new(self._queue.time, self.settings.interval)

    # --- flow A ------------------------------------------------------------------------------------------------------

    def _plan(self, command: Command, *, at_once: bool) -> None:
        """Flow A: ask for a root path and its upper-body motion; take them, if they are there already."""
        hurry = not self._errands.immediate and changed(self._last.command, command)
        time, start = self._planning_start(at_once, hurry)
        root, settings = RootState.of(start.root), self.settings
        if self._last.command.idle or steering.overturned(self._last.command, command):
            way = steering.direction(command, root.heading)
            root = in_step(root, self._shown.root, way, self._check.model.gait.scale)
        others = self._others_beside(start, time, command)
        query = MotionQuery(
            time, root, start.upper, start.upper_velocity, command, settings.queue_size, settings.interval, others,
            hurry,
        )  # fmt: skip
        held = None
        if self._showing.holding.active and self.assist:
            held = Held(start.root, start.upper, self._showing.holding.stance, self._showing.clearance)
        reserve = 0 if self._errands.immediate else round(_RESERVE / settings.interval)
        answer = partial(self._grounds.answer, climbs=self._climbs, may_climb=command.may_climb)
        self._errands.ask(Question(query, self.assist, held, reserve), answer, self._queue)
        self._take_plan(command)

    def _others_beside(self, start: Playback, time: float, command: Command) -> Moving:
        """The others' boxes; slimmer, where a motion starts within one: it is larger than the body that it holds."""
        things = self._pushing.foreseen(self._check, start, self._queue.time, time)
        if not self.others:
            return things
        body = self._check.body(start.root, start.upper)
        others = expected(self._walker(command), body, self.others, self._around.free_map)
        clearance = self._check.clearance_from(others, start.root, start.upper, time)
        return things + (slimmer(others, _LEAVING - clearance) if clearance < 0.0 else others)

    def _planning_start(self, at_once: bool, hurry: bool) -> tuple[float, Playback]:
        """When and from where to plan; where nothing is left to play, it is what is shown now."""
        if self._queue.empty:
            return self._queue.time, self._showing.holding.start(self._shown)
        time = self._errands.start(self._queue, at_once=at_once, hurry=hurry)
        return time, self._queue.at(time)

    def _take_plan(self, command: Command) -> None:
        """On success the queue goes on with the plan, else it keeps what it has."""
        heard = self._errands.hear(self._queue)
        if heard is None:
            return
        if heard.question.assist is not self.assist or steering.overturned(heard.question.query.command, command):
            self._next = Phase.RESET
        elif heard.late:
            self.late_plans += 1
            self._next = Phase.PLAN
        else:
            self._go_on_with(heard.answer, heard.question, heard.start)

    def _go_on_with(self, answer: Answer, question: Question, start: float) -> None:
        self._settle_in(self._grounds.around(climbs=answer.climbs))
        root = answer.root._replace(path=replace(answer.root.path, start_time=start))
        found, command = answer.uppers is not None, question.query.command
        unwanted = self._halting or steering.overturned(self._last.command, command)
        self._halting = unwanted and not found and not self._check.restless  # who stands among what moves is run over
        self._last = self._last.followed_by(answer, root, command, self._queue.time)
        self._next, self._resting = Phase.PLAY, False
        self._blocked = not found and self._queue.empty
        self._queue.start_count()
        if answer.uppers is not None:
            path = replace(answer.path, start_time=start)
            self._queue.splice(path, answer.uppers, question.query.velocity, answer.velocities)
            still = command.idle and not self._check.restless
            self._resting = still and self._showing.changes_nothing(path.states, answer.uppers)

    # --- flow B ------------------------------------------------------------------------------------------------------

    def _play(self, dt: float) -> None:
        """Flow B: interpolate, check, show; what touches is not shown, and leads to flow C, as does an empty queue."""
        ended = (self._queue.empty and not self._errands.continues) or self._showing.goes_back
        held = self._showing.holding.active and not ended
        rate = self._rate(dt)
        self._queue.advance(dt, rate)
        now = self._queue.time
        if self._resting:
            self._showing.rest(now, dt)
            return
        if ended or not self._showing.play(self._queue.sample(), self._queue.ahead(), now, dt):
            self._clear()
            self._next = Phase.RESET
            self._showing.hold(now, dt)
            self._blocked |= self._showing.goes_back
            self._vain |= held and not self._check.footing.plain  # there plans are dear
            return
        self._blocked = self._vain = False
        if rate < _STANDING_RATE and self._halting:
            self._clear()
        if self._queue.empty:
            self._next = Phase.RESET

    def _rate(self, dt: float) -> float:
        """How fast to play: slower where the motion would end before a plan has come; its poses stay the same."""
        left = self._queue.left if self._queue.ends_moving else math.inf
        return self._errands.foresight.next_rate(left, dt, halting=self._halting)

    # --- flow C ------------------------------------------------------------------------------------------------------

    def _reset_queue(self) -> None:
        """Flow C: what is in the queue is not wanted any more. It is still played until there is something else.

        Where nothing moves, and that is there at once, it is not: one stands until a way is found.
        """
        if self._errands.immediate and not self._check.restless:
            self._queue.clear()

    def _clear(self) -> None:
        """Empty the queue; a plan in the making that goes on from it is of no use then."""
        self._queue.clear()
        self._halting = False
        self._errands.drop_continued()

    # --- what is shown -----------------------------------------------------------------------------------------------

    def _frame(self, command: Command) -> Frame:
        key_frames = self._queue.unplayed()
        return Frame(
            time=self._queue.time,
            q=configuration(self._shown.root, self._shown.upper),
            root=self._shown.root,
            phase=self._flow,
            clearance=self._showing.clearance,
            stuck=self._is_stuck(command),
            touching=self._showing.clearance < 0.0,
            fill=min(len(key_frames.times), self.settings.queue_size),
            key_frames=key_frames,
            plan=self._last.report,
            command=command,
        )

    def _is_stuck(self, command: Command) -> bool:
        """Whether the user pushes, and planning has found no way on."""
        return not command.idle and self._no_way_on

    @property
    def _no_way_on(self) -> bool:
        """Whether planning has found no way on, or stands where the root has none."""
        return self._blocked or (self._last.stops and self.stands)
