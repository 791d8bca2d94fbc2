"""A scene of people while it is written: who is there, and the capture of all their limbs."""

import zlib
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.spatial.transform import Rotation

from capar.model.capture import Agent, Capture, Role, Sensor, Shape, Stream, TagObject, TagType
from scenes.hands import shapes
from scenes.hands.expectation import Step
from scenes.hands.paths import Body, Vector, pose
from scenes.hands.stage import Noise, Stage, other_names
from scenes.hands.things import Thing
from scenes.people.limbs import Limb

LASTING = frozenset({"Rest", "Touch", "TouchWith", "TouchOneself", "Stand", "StandOnOneLeg"})
"""Steps in which nothing moves, so that two in a row are one."""

FLOOR_M = 8.0
"""Length and width of the floor [m]."""


@dataclass
class Watcher:
    """A part of a body that is tracked and does not act: a head, the lower back."""

    body: Body
    part: str
    agent: str
    form: shapes.Form | None = None


@dataclass
class PeopleStage(Stage):
    """A stage on a floor, for one or several people."""

    people: dict[str, float] = field(default_factory=dict)
    """Stature of everybody by name [m]."""

    watchers: list[Watcher] = field(default_factory=list)
    hands_as_objects: bool = False
    """Whether hands are declared as objects too, as where people touch each other."""

    def __post_init__(self) -> None:
        """Lay the floor."""
        half = FLOOR_M / 2.0
        form = shapes.Form("floor", (shapes.block((-half, -half, -0.1), (half, half, 0.0)),))
        self.floor = self.put("floor", form, (0.0, 0.0, 0.0), tag="fixed")

    def desk(self, at: Vector, size: Vector = (0.6, 1.2), name: str = "table") -> Thing:
        """A table's top, with its middle at a place whose third number is its height [m]."""
        x, y = size[0] / 2.0, size[1] / 2.0
        form = shapes.Form(name, (shapes.block((-x, -y, -0.04), (x, y, 0.0)),))
        return self.put(name, form, at, tag="fixed")

    def close(self) -> None:
        """Draw out what stands to the end, as steps of their own."""
        end = self.duration_s
        for limb in self.hands:
            if isinstance(limb, Limb) and limb.member == "foot" and limb.touched:
                limb.clock = end
                if limb.clock - limb.border > 0.0:
                    limb.step("Stand", limb.touched)
            limb.steps = joined(limb.steps)
            if isinstance(limb, Limb) and limb.aliases:
                limb.alternative = other_names(limb, **limb.aliases)

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

        limbs = [each for each in self.hands if isinstance(each, Limb)]
        sensors = [_acting(each, stream(each.body, tracked=True)) for each in limbs]
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
                agent=known[each.name].agent if each.name in known else "",
            )
            for each in self.things
        ]
        agents = [Agent(name, measures={"stature": tall}) for name, tall in self.people.items()]
        return Capture(
            self.name,
            (*sensors, *seen),
            (*objects, *(_declared(sensors) if self.hands_as_objects else ())),
            agent=agents[0],
            others=tuple(agents[1:]),
            contact_minimum_s=self.contact_minimum_s,
        )


def _declared(sensors: list[Sensor]) -> list[TagObject]:
    """Hands as objects, for people who touch each other."""
    return [
        TagObject(each.name, TagType.SELF, each.stream, each.shape, "hand", agent=each.agent)
        for each in sensors
        if each.end_effector == "hand"
    ]


def joined(steps: list[Step]) -> list[Step]:
    """Steps of which those that only go on with the one before are one with it."""
    out: list[Step] = []
    for each in steps:
        if out and each.name in LASTING and each.action == out[-1].action:
            out[-1] = replace(out[-1], end_s=each.end_s)
        else:
            out.append(each)
    return out


def _acting(limb: Limb, stream: Stream) -> Sensor:
    chain = {"hand": "arm", "foot": "leg"}[limb.member]
    return Sensor(
        limb.name, limb.member, limb.side, f"{limb.side}_{chain}", stream, surface(limb.form),
        agent=limb.agent,
    )  # fmt: skip


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
