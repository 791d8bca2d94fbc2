"""A scene while it is written: things, hands, and from them the capture and the expectation."""

import zlib
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.spatial.transform import Rotation

from capar.model.capture import Agent, Capture, Role, Sensor, Shape, Stream, TagObject, TagType
from scenes.hands import shapes
from scenes.hands.paths import Body, Poses, Times, Vector, pose
from scenes.hands.performer import Hand
from scenes.hands.things import Expectation, Step, Thing, Unit


@dataclass(frozen=True)
class Noise:
    """What a tracker adds to a pose: standard deviations in metres and radians."""

    position_m: float
    rotation_rad: float

    def added(self, poses: Poses, random: np.random.Generator) -> Poses:
        """Noisy poses."""
        out = poses.copy()
        out[:, :3, 3] += self.position_m * random.standard_normal((len(out), 3))
        turns = Rotation.from_rotvec(self.rotation_rad * random.standard_normal((len(out), 3)))
        out[:, :3, :3] = turns.as_matrix() @ out[:, :3, :3]
        return out


@dataclass
class Watcher:
    """A part of a body that is tracked and does not act: a head, the lower back."""

    body: Body
    part: str
    agent: str
    form: shapes.Form | None = None


@dataclass
class Finger:
    """A part of a hand that is tracked apart from it: what it touches the hand touches."""

    body: Body
    hand: Hand
    form: shapes.Form
    touches: list[tuple[Thing, float, float]] = field(default_factory=list)
    """What it touches, from when to when [s]."""

    @property
    def name(self) -> str:
        """Its sensor's name."""
        return self.body.name


@dataclass
class Stage:
    """The scene in its own frame: the performer at the origin, looking along x, z up."""

    name: str
    height: float = 0.74
    """Height of the table's top [m]."""

    yaw_deg: float = 0.0
    """How the scene's x axis stands in the capture's world."""

    offset: tuple[float, float] = (0.0, 0.0)
    """Where the performer stands in the capture's world [m]."""

    size: float = 1.0
    """Of the performer, relative to an adult of middle size."""

    agent: str = "agent"
    contact_minimum_s: float | None = None
    things: list[Thing] = field(default_factory=list)
    hands: list[Hand] = field(default_factory=list)
    fingers: list[Finger] = field(default_factory=list)
    watchers: list["Watcher"] = field(default_factory=list)
    people: dict[str, float] = field(default_factory=dict)
    """Stature of everybody by name [m], where it is given."""

    hands_as_objects: bool = False
    """Whether hands are declared as objects too, as where people touch each other."""

    def put(
        self, name: str, form: shapes.Form, at: Vector, *, yaw_deg: float = 0.0, tag: str = "mobile"
    ) -> Thing:
        """Set a thing with its origin at a place; two coordinates mean on the table."""
        place = (*at, self.height) if len(at) == 2 else tuple(at)
        first = pose(place, Rotation.from_euler("z", yaw_deg, degrees=True))
        thing = Thing(Body(name, first), form, TagType(tag))
        self.things.append(thing)
        return thing

    def table(self, depth: float = 0.7, width: float = 1.4) -> Thing:
        """The table in front of the performer."""
        form = shapes.Form("table", (shapes.block((0, -width / 2, -0.04), (depth, width / 2, 0)),))
        return self.put("table", form, (0.3, 0.0, self.height), tag="fixed")

    def head(self) -> Thing:
        """The performer's head, standing or sitting as the table's height suggests."""
        place = (0.02, 0.0, self.height + 0.45 * self.size)
        return self.put("head", shapes.ball(0.095 * self.size, "head"), place, tag="self")

    def chest(self) -> Thing:
        """The performer's chest."""
        low, high = (-0.1, -0.16, -0.14), (0.1, 0.16, 0.14)
        form = shapes.Form("chest", (shapes.block(low, high),))
        return self.put("chest", form, (-0.06, 0.0, self.height + 0.18), tag="self")

    def hand(
        self,
        side: str,
        form: shapes.Form | None = None,
        home: Vector | None = None,
        idle: float = 0.0,
    ) -> Hand:
        """A hand of the performer at its home posture, where it stays for a while [s]."""
        sign = -1.0 if side == "right" else 1.0
        shape = (form or shapes.flat_hand(side)).scaled(self.size)
        place = home or (0.12, sign * 0.28 * self.size, self.height + 0.12)
        hand = Hand.at_home(f"{side}_hand", side, shape, place)
        hand.idle(idle)
        self.hands.append(hand)
        return hand

    def right(
        self, form: shapes.Form | None = None, home: Vector | None = None, idle: float = 0.0
    ) -> Hand:
        """The right hand."""
        return self.hand("right", form, home, idle)

    def left(
        self, form: shapes.Form | None = None, home: Vector | None = None, idle: float = 0.0
    ) -> Hand:
        """The left hand."""
        return self.hand("left", form, home, idle)

    @property
    def duration_s(self) -> float:
        """When the last hand has finished [s]."""
        return max(each.clock for each in self.hands)

    def times(self, rate_hz: float) -> Times:
        """The capture's time stamps [s]."""
        return np.arange(round(self.duration_s * rate_hz) + 1) / rate_hz

    def capture(self, rate_hz: float, noise: Noise, seed: int) -> Capture:
        """What a tracker records of the scene."""
        times = self.times(rate_hz)
        random = np.random.default_rng([seed, zlib.crc32(self.name.encode())])
        world = pose((*self.offset, 0.0), Rotation.from_euler("z", self.yaw_deg, degrees=True))

        def stream(body: Body, *, tracked: bool) -> Stream:
            poses = world @ body.poses(times)
            poses = noise.added(poses, random) if tracked else poses
            turned = Rotation.from_matrix(poses[:, :3, :3]).as_quat(scalar_first=True)
            return Stream(times, poses[:, :3, 3], turned)

        sensors = [_acting(each, stream(each.body, tracked=True)) for each in self.hands]
        sensors += [_part(each, stream(each.body, tracked=True)) for each in self.fingers]
        seen = [_attending(each, stream(each.body, tracked=True)) for each in self.watchers]
        known = {each.name: each for each in (*sensors, *seen)}
        objects = [
            TagObject(
                each.name,
                each.tag,
                known[each.name].stream
                if each.name in known
                else stream(each.body, tracked=each.tag is not TagType.FIXED),
                surface(each.form),
                kind=each.form.kind,
                part_of=each.part_of,
                closed_deg=each.closed_deg,
                closed_m=each.closed_m,
                agent=known[each.name].agent if each.name in known else "",
            )
            for each in self.things
        ]
        declared = [
            TagObject(each.name, TagType.SELF, each.stream, each.shape, "hand", agent=each.agent)
            for each in sensors
            if self.hands_as_objects and each.end_effector == "hand"
        ]
        agents = [Agent(name, measures={"stature": tall}) for name, tall in self.people.items()]
        return Capture(
            self.name,
            (*sensors, *seen),
            (*objects, *declared),
            agent=agents[0] if agents else Agent(self.agent),
            others=tuple(agents[1:]),
            contact_minimum_s=self.contact_minimum_s,
        )

    def close(self) -> None:
        """Write down what goes on to the end."""

    def expectation(self, rate_hz: float) -> Expectation:
        """What each hand does in it, up to the last frame."""
        end = float(self.times(rate_hz)[-1])
        return Expectation(
            self.name,
            tuple(
                Unit(each.name, drawn_out(each.steps, end), drawn_out(each.alternative, end))
                for each in self.hands
            ),
        )


def _acting(hand: Hand, stream: Stream) -> Sensor:
    link = f"{hand.side}_{'arm' if hand.member == 'hand' else 'leg'}"
    shape = surface(hand.form)
    return Sensor(hand.name, hand.member, hand.side, link, stream, shape, agent=hand.agent)


def _part(each: Finger, stream: Stream) -> Sensor:
    own = replace(each.hand, body=each.body, form=each.form)
    return replace(_acting(own, stream), part_of=each.hand.name)


def _attending(each: Watcher, stream: Stream) -> Sensor:
    link = {"head": "neck"}.get(each.part, each.part)
    shape = surface(each.form) if each.form else None
    return Sensor(
        each.body.name, each.part, "none", link, stream, shape, Role.ATTENDS, agent=each.agent
    )


def surface(form: shapes.Form) -> Shape:
    """A form's surface as a capture has it."""
    mesh = form.mesh
    return Shape(np.asarray(mesh.vertices), np.asarray(mesh.faces), description=form.kind)


def other_names(hand: Hand, **names: str) -> tuple[Step, ...]:
    """A hand's steps with some names exchanged."""
    return tuple(replace(each, name=names.get(each.name, each.name)) for each in hand.steps)


def drawn_out(steps: Sequence[Step], end: float) -> tuple[Step, ...]:
    """The steps, the last one drawn out to the end of the capture [s]."""
    return (*steps[:-1], *(replace(each, end_s=end) for each in steps[-1:]))
