"""A performance as a tracker would have recorded it: a capture, a bundle, and the exact truth."""

from collections.abc import Collection, Iterable, Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.gaze_control import lines_of_sight
from capar.body.performing import TOUCH_M, Performance
from capar.body.scripts import SIDES, vector
from capar.body.sensors import PERFECT, Mount, Tracker, recorded, sense, strap_on
from capar.body.shapes import moved, segment_surface
from capar.body.skeleton import skeleton
from capar.model import geometry
from capar.model.capture import Agent, Capture, Role, Sensor, Stream, TagObject, TagType

#: What a hand's surface consists of; the thumb is left out, as it moves against them
HAND_SEGMENTS = ("hand", "fingers", "fingertips")
LINKS = {"hand": "arm", "foot": "leg", "head": "neck"}
#: Places of sensors that are worn together; ``thesis`` are the eleven of thesis 5.1
RIGS = {
    "hands": ("right_hand", "left_hand", "head"),
    "thesis": (
        "right_hand", "left_hand", "head", "neck", "l5", "right_elbow", "left_elbow",
        "right_knee", "left_knee", "right_foot", "left_foot",
    ),
}  # fmt: skip


@dataclass(frozen=True, eq=False)
class Truth:
    """What is so in a performance, to the frame."""

    #: Two bodies that touch, from when to when [s], sorted
    contacts: tuple[tuple[str, str, float, float], ...]
    motions: tuple[tuple[str, float, float], ...]  #: A thing that moves, from when to when [s]
    #: Name, start and end of each phase of the script [s]
    phases: tuple[tuple[str, float, float], ...]
    #: What is looked at while a phase lasts, from when to when [s]
    looks: tuple[tuple[str, float, float], ...]


def truth_of(made: Performance) -> Truth:
    """What is so, from the script's own places and not from what a tracker sees."""

    def intervals(holds: np.ndarray) -> list[tuple[float, float]]:
        runs = geometry.runs(np.asarray(holds))
        return [(float(made.times[a]), float(made.times[b])) for a, b in runs]

    spans: list[tuple[str, str, np.ndarray]] = []
    for side in SIDES:
        held: dict[str, np.ndarray] = {}
        for phase, (_, start, end) in zip(made.script, made.phases, strict=True):
            hand = phase.hand(side)
            for name in (hand.thing, *hand.beside) if hand.does == "holds" else ():
                now = (made.times >= start - 1e-9) & (made.times < end - 1e-9)
                held[name] = held.get(name, np.zeros(len(made.times), dtype=bool)) | now
        spans += [(f"{side}_hand", name, when) for name, when in held.items()]
    motions = []
    mouth = made.human.sites(made.motion, ["mouth"])["mouth"][0]
    for name, thing in made.scene.things.items():
        path = made.things[name]
        if made.scene.table and thing.tag is TagType.MOBILE:
            stands = np.abs(path.translation[:, 2] - thing.place[2]) < TOUCH_M
            upright = (path.rotation * thing.pose.rotation.inv()).magnitude() < 0.01
            spans.append((name, made.scene.table.name, stands & upright))
        low, high = thing.shape.bounds  # the mouth touches the rim
        local = path.rotation.inv().apply(mouth - path.translation)
        apart = np.hypot(
            np.linalg.norm(local[:, :2], axis=1) + low[0], np.abs(local[:, 2] - high[2])
        )
        spans.append((name, "head", apart < TOUCH_M))
        step = np.linalg.norm(np.diff(path.translation, axis=0), axis=1)
        turn = (path.rotation[1:] * path.rotation[:-1].inv()).magnitude()
        moves = np.append((step > 1e-9) | (turn > 1e-9), False)
        motions += [(name, *span) for span in intervals(moves)]
    contacts = sorted((a, b, *span) for a, b, when in spans for span in intervals(when))
    looks = zip(made.looks, made.phases, strict=True)
    seen = tuple((look, start, end) for look, (_, start, end) in looks if look)
    return Truth(tuple(contacts), tuple(motions), made.phases, seen)


def record(
    made: Performance,
    *,
    name: str,
    seed: int,
    tracker: Tracker | None = None,
    sensors: tuple[str, ...] = RIGS["hands"],
    acting: Collection[str] | None = None,
    eye_tracker: bool = True,
    agent: str = "performer",
) -> Capture:
    """The capture of a performance.

    Args:
        made: What was done.
        name: Of the capture.
        seed: Of noise, places of sensors and losses.
        tracker: Its faults; a MotionStar's where None.
        sensors: Places of those that are worn.
        acting: Places of those that act, all others attend; hands and feet where None.
        eye_tracker: Whether a worn head is recorded with its eyes (a sensor ``eyes``).
        agent: Name of who performed; its kind and measures are those of the body.

    Raises:
        UnknownNameError: A place is none of the model's.
    """
    tracker, rng = tracker or Tracker(), np.random.default_rng(seed)
    mounts = strap_on(made.human, sensors, tracker, rng)
    streams = sense(made.human, made.times, made.motion, mounts, tracker, rng)
    worn = [_sensor(made, mounts[place], streams[place], acting) for place in sensors]
    objects = []
    for thing in made.scene.things.values():
        faults = PERFECT if thing.tag is TagType.FIXED else tracker
        stream, kind = recorded(made.times, made.things[thing.name], faults, rng), thing.kind
        one = TagObject(thing.name, thing.tag, stream, thing.shape, kind or thing.name)
        objects.append(replace(one, mass_kg=thing.mass_kg))
    heads = [
        TagObject("head", TagType.SELF, each.stream, each.shape, "head")
        for each in worn
        if each.name == "head"
    ]
    if eye_tracker and heads:  # drawn last, so that the others' noise does not depend on it
        worn.append(_eyes(made, tracker, rng))
    measures = {k: round(v, 4) for k, v in made.human.measures.values.items()}
    kind = "child" if made.human.measures.adult_share < 0.5 else made.human.measures.adult
    return Capture(
        name=name,
        sensors=tuple(worn),
        objects=(*heads, *objects),
        agent=Agent(agent, kind, {"age": made.human.measures.age, **measures}),
    )


def _sensor(
    made: Performance, mount: Mount, stream: Stream, acting: Collection[str] | None
) -> Sensor:
    """A worn sensor with the surface of what it is worn on, in its own frame."""
    side, _, part = mount.place.rpartition("_")
    seat = mount.pose.inv()
    if mount.place == "head":
        spots, _ = lines_of_sight(made.human, made.human.posture()[None])
        origin = skeleton(made.human.measures)["head"].origin
        head = RigidTransform.from_translation(origin)
        eye = seat.apply(head.inv().apply(spots[0]))
        ahead = seat.rotation.apply(head.rotation.inv().apply([1.0, 0.0, 0.0]))
        surface = moved(segment_surface(made.human.measures, ("head",), "head"), seat)
        return Sensor(
            "head", "head", "none", "neck", stream, surface,
            Role.ATTENDS, vector(ahead), vector(eye),
        )  # fmt: skip
    shape = None
    if part == "hand":
        parts = tuple(f"{side}_{segment}" for segment in HAND_SEGMENTS)
        shape = moved(segment_surface(made.human.measures, parts, f"{side}_hand"), seat)
    link = f"{side}_{LINKS.get(part, part)}" if side else mount.place
    acts = part in {"hand", "foot"} if acting is None else mount.place in acting
    role = Role.ACTS if acts else Role.ATTENDS
    return Sensor(mount.place, part, side or "none", link, stream, shape, role)


def _eyes(made: Performance, tracker: Tracker, rng: np.random.Generator) -> Sensor:
    """What an eye tracker on the head records: origin between the eyes, x along the sight."""
    spots, ways = lines_of_sight(made.human, made.motion)
    yaw = np.arctan2(ways[:, 1], ways[:, 0])
    pitch = np.arcsin(np.clip(-ways[:, 2], -1.0, 1.0))
    level = Rotation.from_euler("ZY", np.stack([yaw, pitch], axis=1))
    pose = RigidTransform.from_components(spots, level)
    stream = recorded(made.times, pose, tracker, rng)
    return Sensor("eyes", "eyes", "none", "neck", stream, None, Role.ATTENDS)


def write_bundle(capture: Capture, truth: Truth, folder: Path) -> None:
    """Write a capture bundle with its truth beside it; the same capture gives the same bytes."""
    folder.mkdir(parents=True, exist_ok=True)
    tracked = {n: b for n, b in sorted(capture.bodies.items()) if not _fixed(b)}
    parts = ("x", "y", "z", "qx", "qy", "qz", "qw", "valid")
    rows = [",".join(["t_s", *(f"{name}_{part}" for name in tracked for part in parts)])]
    for frame, time in enumerate(capture.times):
        cells = [f"{time:.9f}"]
        for each in tracked.values():
            cells += [f"{value:.7f}" for value in each.stream.positions[frame]]
            cells += [f"{value:.8f}" for value in np.roll(each.stream.orientations[frame], -1)]
            cells.append("0" if each.stream.lost[frame] else "1")
        rows.append(",".join(cells))
    files = {"motion.csv": rows, "capture.toml": _toml(capture), "truth.toml": _truth_toml(truth)}
    bodies: list[Sensor | TagObject] = [*capture.objects, *capture.sensors]
    for body in bodies:
        if body.shape is not None:
            corners = [f"v {x:.7f} {y:.7f} {z:.7f}" for x, y, z in body.shape.vertices]
            faces = [f"f {a} {b} {c}" for a, b, c in body.shape.faces + 1]
            files[f"{body.name}.obj"] = [f"# {body.shape.description} [m]", *corners, *faces]
    for name, lines in files.items():
        (folder / name).write_bytes(("\n".join(lines) + "\n").encode())


def _fixed(body: Sensor | TagObject) -> bool:
    return isinstance(body, TagObject) and body.tag is TagType.FIXED


def _toml(capture: Capture) -> list[str]:
    out = [
        "# A virtual performer's trial; truth.toml beside it says what is so.",
        f'name = "{capture.name}"', 'unit = "m"', 'up = "z"', "",
        "[files]", 'motion = "motion.csv"', "",
    ]  # fmt: skip
    for agent in capture.agents:
        measures = ", ".join(f"{k} = {v}" for k, v in sorted(agent.measures.items()))
        out += [""] * (agent is not capture.agent) + ["[[agent]]" if capture.others else "[agent]"]
        out += [f'name = "{agent.name}"', f'kind = "{agent.kind}"', f"measures = {{ {measures} }}"]
    for sensor in capture.sensors:
        out += ["", "[[sensor]]", f'name = "{sensor.name}"']
        out += [f'end_effector = "{sensor.end_effector}"']
        out += [f'agent = "{sensor.agent}"'] * bool(sensor.agent)
        out += [f'side = "{sensor.side}"'] * (sensor.side != "none")
        out += [f'link = "{sensor.link}"', f'role = "{sensor.role}"', f'body = "{sensor.name}"']
        if sensor.end_effector in {"head", "eyes"}:
            out += [f"eye = {_list(sensor.eye)}", f"gaze = {_list(sensor.gaze)}"]
        out += [f'shape = {{ mesh = "{sensor.name}.obj" }}'] * (sensor.shape is not None)
    for thing in capture.objects:
        turn = np.roll(thing.stream.orientations[0], -1)
        turned = bool(_fixed(thing) and abs(turn[3]) <= 1 - 1e-12)
        out += ["", "[[object]]", f'name = "{thing.name}"', f'tag = "{thing.tag}"']
        out += [f'agent = "{thing.agent}"'] * bool(thing.agent)
        out += [f'kind = "{thing.kind}"'] * bool(thing.kind)
        out += [f'body = "{thing.name}"'] * (not _fixed(thing))
        out += [f"position = {_list(thing.stream.positions[0])}"] * _fixed(thing)
        out += [f"orientation = {_list(turn)}"] * turned
        out += [f'shape = {{ mesh = "{thing.name}.obj" }}'] * (thing.shape is not None)
        out += [f"mass_kg = {thing.mass_kg}"] * (thing.mass_kg is not None)
        out += [f'part_of = "{thing.part_of}"'] * bool(thing.part_of)
        closed = {"closed_deg": thing.closed_deg, "closed_m": thing.closed_m}
        out += [f"{key} = {value}" for key, value in closed.items() if value is not None]
    for purpose in capture.purposes:
        out += ["", "[[purpose]]"]
        out += [f'{key} = "{value}"' for key, value in asdict(purpose).items() if value]
    return out


def _list(values: Iterable[float]) -> str:
    return "[" + ", ".join(f"{float(each):.7f}" for each in values) + "]"


def _truth_toml(truth: Truth) -> list[str]:
    out = ["# Exact, by the script; times in seconds from the first frame."]
    for first, second, a, b in truth.contacts:
        out += ["", "[[contact]]", f'bodies = ["{first}", "{second}"]', f"span_s = {_list((a, b))}"]
    for kind, rows in (("motion", truth.motions), ("phase", truth.phases), ("look", truth.looks)):
        for name, a, b in rows:
            out += ["", f"[[{kind}]]", f'name = "{name}"', f"span_s = {_list((a, b))}"]
    return out


def record_together(
    made: Mapping[str, Performance], *, name: str, seed: int, tracker: Tracker = PERFECT
) -> Capture:
    """The capture of a performance of several bodies; the first one's bodies keep their names."""
    captures = {
        who: record(done, name=name, seed=seed + number, tracker=tracker)
        for number, (who, done) in enumerate(made.items())
    }
    first = next(iter(captures))
    prefixes = {who: "" if who == first else f"{who}_" for who in captures}
    names = {
        who: {sensor.name: prefixes[who] + sensor.name for sensor in capture.sensors}
        for who, capture in captures.items()
    }
    return joined(captures, names)


def joined(captures: Mapping[str, Capture], names: Mapping[str, Mapping[str, str]]) -> Capture:
    """One capture of everybody, from one of each in which the objects are the same.

    What sensors and parts of bodies are called in it is given by agent.
    """
    sensors: list[Sensor] = []
    parts: list[TagObject] = []
    agents = [Agent(who, c.agent.kind, c.agent.measures) for who, c in captures.items()]
    for who, capture in captures.items():
        called = names[who]
        sensors += [replace(s, name=called.get(s.name, s.name), agent=who) for s in capture.sensors]
        parts += [
            replace(part, name=called.get(part.name, part.name), agent=who)
            for part in capture.objects
            if part.tag is TagType.SELF
        ]
    first = next(iter(captures.values()))
    things = [thing for thing in first.objects if thing.tag is not TagType.SELF]
    return replace(
        first, sensors=tuple(sensors), objects=(*parts, *things), agent=agents[0],
        others=tuple(agents[1:]),
    )  # fmt: skip


def truth_together(made: Mapping[str, Performance]) -> Truth:
    """What is so in a performance of several bodies, with the names of their capture."""
    leader, *others = made
    truths = {who: truth_of(performance) for who, performance in made.items()}
    contacts = set(truths[leader].contacts)
    for who in others:
        own = {part: f"{who}_{part}" for part in ("right_hand", "left_hand", "head")}
        rows = truths[who].contacts
        contacts |= {(own.get(a, a), own.get(b, b), first, last) for a, b, first, last in rows}
    looks = [look for truth in truths.values() for look in truth.looks]
    return replace(truths[leader], contacts=tuple(sorted(contacts)), looks=tuple(looks))
