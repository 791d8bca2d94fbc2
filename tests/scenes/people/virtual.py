"""People whose every joint moves: virtual bodies, as a stage has them."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cache

import numpy as np
from jaxtyping import Float
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import RigidTransform, Rotation, Slerp

from capar.body.anthropometry import Measures, ready_made
from capar.body.human import Human
from capar.body.performing import RELAXED, Performance, perform
from capar.body.recording import HAND_SEGMENTS
from capar.body.scripts import SIDES, Script
from capar.body.shapes import form_mesh, forms
from capar.body.skeleton import HEEL, skeleton
from capar.body.virtual_scenes import Scene as BodyScene
from capar.body.virtual_scenes import Thing as BodyThing
from capar.body.virtual_scenes import scene as body_scene
from capar.model.capture import TagType
from scenes.hands.clearance import Placed, gap
from scenes.hands.paths import Body, Poses, Times, min_jerk, pose
from scenes.hands.shapes import Form, block
from scenes.hands.stage import Watcher, surface
from scenes.hands.things import Thing
from scenes.people.stage import Limb, PeopleStage

BESIDE_S = 0.5
"""So long before and after a contact a virtual hand is near what it touches [s]."""

MET_M = 0.001
"""Surfaces that are nearer touch: the performer leaves half a millimetre between them [m]."""

FINE_S = 0.01
"""How exactly the time of a contact is told [s]."""

RATE_HZ = 40.0
"""How finely a body is solved; between frames its parts move along splines [Hz]."""


@dataclass
class Played(Body):
    """A body that moves as it was solved."""

    times: Times = field(default_factory=lambda: np.zeros(2))
    path: CubicSpline | None = None
    turns: Slerp | None = None

    @classmethod
    def of(
        cls,
        name: str,
        times: Times,
        places: Float[np.ndarray, "frames 3"],
        quaternions: Float[np.ndarray, "frames 4"],
    ) -> "Played":
        """A body through places [m] with orientations (w x y z)."""
        turned = Rotation.from_quat(quaternions, scalar_first=True)
        first = pose(places[0], turned[0])
        path = CubicSpline(times, places, bc_type="clamped")
        return cls(name, first, [], times, path, Slerp(times, turned))

    def poses(self, times: Times) -> Poses:
        """Poses at times [s]; before and after, it stays."""
        assert self.path is not None and self.turns is not None
        inside = np.clip(times, self.times[0], self.times[-1])
        out = np.tile(np.eye(4), (len(times), 1, 1))
        out[:, :3, 3] = self.path(inside)
        out[:, :3, :3] = self.turns(inside).as_matrix()
        return out


@cache
def human(who: str) -> Human:
    """A man, a woman or a child of middle size."""
    return Human.of(ready_made(who))


def body_form(measures: Measures, segments: Sequence[str], kind: str) -> Form:
    """The surface of some segments, in the first one's frame, as convex parts."""
    bones = skeleton(measures)
    parts = []
    for each in forms(measures, bones):
        if each.body in segments:
            mesh = form_mesh(each)
            mesh.apply_translation(bones[each.body].origin - bones[segments[0]].origin)
            parts.append(mesh)
    return Form(kind, tuple(parts))


def shoe(ankle: Float[np.ndarray, "4 4"], length: float) -> Form:
    """A shoe whose sole lies flat on the floor where the body first stands, in the foot's frame."""
    x, y, _ = ankle[:3, 3]
    low, high = (x - HEEL * length, y - 0.17 * length, 0.0), (x, y + 0.17 * length, 0.3 * length)
    parts = [
        block(low, (x + 0.4 * length, *high[1:])),
        block((x, low[1], 0.0), (x + (1.0 - HEEL) * length, high[1], 0.15 * length)),
    ]
    for part in parts:
        part.apply_transform(np.linalg.inv(ankle))
    return Form("foot", tuple(parts))


@dataclass
class Figure:
    """A virtual body on a stage."""

    human: Human
    hands: dict[str, Limb]
    feet: dict[str, Limb]
    head: Thing
    things: dict[str, Thing] = field(default_factory=dict)
    phases: list[tuple[float, float]] = field(default_factory=list)

    def does(self, side: str, *steps: tuple[int, str, tuple[str, ...]]) -> None:
        """Say what a hand does: to the end of which phase, the step's name and its objects."""
        hand = self.hands[side]
        known = {**self.things, "head": self.head}
        for number, name, objects in steps:
            hand.clock = self.phases[number][1]
            hand.step(name, *(known[each] for each in objects))

    def holds(self, side: str, name: str, first: int, last: int) -> None:
        """Write down that a hand touches a thing from one phase to another.

        The surfaces meet a little before the script says so, and part a little after: borders of
        steps stand there.
        """
        hand, thing = self.hands[side], self.things[name]
        told = self.phases[first][0], self.phases[last][1]
        start = _met(hand, thing, told[0], -1.0)
        end = _met(hand, thing, told[1], 1.0)
        hand.contacts.append((thing, start, end))
        moved = dict(zip(told, (start, end), strict=True))
        hand.steps = [
            replace(
                each,
                start_s=moved.get(each.start_s, each.start_s),
                end_s=moved.get(each.end_s, each.end_s),
            )
            for each in hand.steps
        ]

    def rests(self, *sides: str) -> None:
        """Hands that do nothing rest to the end."""
        for side in sides:
            self.hands[side].wait(self.phases[-1][1])


def figure(
    s: PeopleStage, who: str, times: Times, motion: Float[np.ndarray, "frames posture"]
) -> Figure:
    """Put a body that moves so on the stage, with hands, feet, head and lower back tracked."""
    body = human(who)
    s.people["agent"] = round(float(body.measures["stature"]), 3)
    names = ["head", "pelvis", *(f"{side}_{part}" for side in SIDES for part in ("hand", "foot"))]
    found = body.sites(motion, names)

    def moving(name: str, segment: str) -> Played:
        return Played.of(name, times, *found[segment])

    skull = body_form(body.measures, ["head"], "head")
    head = Thing(moving("head", "head"), skull, TagType.SELF)
    s.things.append(head)
    s.watchers.append(Watcher(head.body, "head", "agent", skull))
    s.watchers.append(Watcher(moving("l5", "pelvis"), "l5", "agent"))
    hands, feet = {}, {}
    for side in SIDES:
        shape = body_form(body.measures, [f"{side}_{each}" for each in HAND_SEGMENTS], "hand")
        own = moving(f"{side}_hand", f"{side}_hand")
        hands[side] = Limb(own, side, shape, own.first, agent="agent", beside_s=BESIDE_S)
    for side in SIDES:
        own = moving(f"{side}_foot", f"{side}_foot")
        shape = shoe(own.first, float(body.measures["foot_length"]))
        feet[side] = Limb(own, side, shape, own.first, member="foot", agent="agent")
        feet[side].meet(s.floor)
    s.hands.extend([*hands.values(), *feet.values()])
    return Figure(body, hands, feet, head)


def performing(
    s: PeopleStage,
    who: str,
    script: Script,
    table: Form,
    table_at: tuple[float, float, float],
    *wares: tuple[str, Form, tuple[float, float, float], bool],
) -> Figure:
    """Let a virtual performer do a script at a table.

    Args:
        s: The stage.
        who: ``man``, ``woman`` or ``child``.
        script: What is done.
        table: Form of the table.
        table_at: Where it stands [m].
        wares: Name, form, place [m] and whether it may be taken from any side, of each thing.
    """
    fixed = BodyThing("table", surface(table), table_at, tag=TagType.FIXED)
    things = [BodyThing(n, surface(f), at, round=around) for n, f, at, around in wares]
    where: BodyScene = body_scene(fixed, *things)
    made = perform(human(who), where, script, rate_hz=RATE_HZ)
    times = np.concatenate([[0.0], made.times + 1.0 / RATE_HZ])
    seen = figure(s, who, times, np.concatenate([made.motion[:1], made.motion]))
    shapes = {"table": table, **{n: f for n, f, _, _ in wares}}
    for name, form in shapes.items():
        seen.things[name] = _thing(made, name, form, times)
        s.things.append(seen.things[name])
    seen.phases.extend((start, end) for _, start, end in made.phases)
    return seen


def _met(hand: Limb, thing: Thing, time: float, way: float) -> float:
    """The time next to another one, before or after it, up to which surfaces touch [s]."""
    while gap(Placed.at(hand, time + way * FINE_S), Placed.at(thing, time + way * FINE_S)) < MET_M:
        time += way * FINE_S
    return time


def _thing(made: Performance, name: str, form: Form, times: Times) -> Thing:
    start = made.scene.thing(name).pose
    path: RigidTransform = made.things[name]
    places = np.concatenate([start.translation[None], path.translation])
    turns = np.concatenate(
        [start.rotation.as_quat(scalar_first=True)[None], path.rotation.as_quat(scalar_first=True)]
    )
    return Thing(Played.of(name, times, places, turns), form, made.scene.thing(name).tag)


def stature(who: str) -> float:
    """Of a ready-made body [m]."""
    return float(human(who).measures["stature"])


@dataclass(frozen=True)
class Bend:
    """A hinge that turns by an angle [degrees] from rest to rest between two times [s]."""

    joint: str
    start: float
    end: float
    angle: float


@dataclass(frozen=True)
class Sway:
    """A hinge that swings about where it is by an angle [degrees], so many times."""

    joint: str
    start: float
    rate_hz: float
    cycles: int
    angle: float

    @property
    def end(self) -> float:
        """When it has swung [s]."""
        return self.start + self.cycles / self.rate_hz


def moved(
    s: PeopleStage, who: str, end: float, acts: Sequence[Bend | Sway], *, stance: str = "right"
) -> Figure:
    """A body that stands on a foot and turns hinges; what it stands on decides where it goes.

    Args:
        s: The stage.
        who: ``man``, ``woman`` or ``child``.
        end: When it is over [s].
        acts: What hinges do; they are added up.
        stance: The foot that stays where it is.
    """
    body = human(who)
    times = np.arange(0.0, end + 0.5 / RATE_HZ, 1.0 / RATE_HZ)
    easy = {f"{side}_{name}": float(np.radians(a)) for name, a in RELAXED.items() for side in SIDES}
    easy = {name: angle for name, angle in easy.items() if "knee" not in name}
    motion = np.tile(body.posture(easy), (len(times), 1))
    for each in acts:
        motion[:, body.index(each.joint)] += np.radians(_angles(each, times))
    assert not body.outside(motion).any()
    foot = f"{stance}_foot"
    places, turns = body.sites(motion, [foot])[foot]
    own = RigidTransform.from_components(places, Rotation.from_quat(turns, scalar_first=True))
    root = RigidTransform.from_components(
        motion[:, :3], Rotation.from_quat(motion[:, 3:7], scalar_first=True)
    )
    kept = own[0] * own.inv() * root
    motion[:, :3] = kept.translation
    motion[:, 3:7] = kept.rotation.as_quat(scalar_first=True)
    seen = figure(s, who, times, motion)
    seen.phases.append((0.0, float(times[-1])))
    return seen


def _angles(act: Bend | Sway, times: Times) -> Times:
    if isinstance(act, Bend):
        return np.asarray(act.angle * min_jerk((times - act.start) / (act.end - act.start)))
    since = times - act.start
    inner = np.minimum(since, act.end - times) * 2.0 * act.rate_hz
    wave = min_jerk(inner) * np.sin(2.0 * np.pi * act.rate_hz * since)
    return np.asarray(act.angle * np.where((since > 0) & (times < act.end), wave, 0.0))


def both(joint: str, start: float, end: float, angle: float) -> list[Bend]:
    """The same turn of a hinge at both sides."""
    return [Bend(f"{side}_{joint}", start, end, angle) for side in SIDES]
