"""Things with parts: found by their motion, told apart from the whole, stated by a capture."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scenes.hands.paths import min_jerk
from scenes.hands.shapes import Form, block
from scenes.hands.stage import surface
from scipy.spatial.transform import Rotation, Slerp

from capar.model.capture import Capture, Sensor, Stream, TagObject, TagType
from capar.model.observation import Observation
from capar.pipelines.observation import observe

HAND = Form("hand", (block((-0.09, -0.04, -0.012), (0.09, 0.04, 0.012)),))
TABLE = Form("table", (block((-0.3, -0.7, -0.04), (0.5, 0.7, 0.0)),))
TOP_M = 0.74
LEAD_S = 0.8
Ramp = tuple[float, float, float]
"""From when to when [s] a value grows, and by how much."""

Hold = tuple[float, float, str, np.ndarray]
"""From when to when [s] a hand is on which body, and its pose in that body's frame."""


def at(x: float, y: float, z: float, turn: Rotation | None = None) -> np.ndarray:
    out = np.eye(4)
    out[:3, 3] = x, y, z
    out[:3, :3] = (turn or Rotation.identity()).as_matrix()
    return out


def course(times: np.ndarray, *ramps: Ramp) -> np.ndarray:
    """The sum of smooth steps at each time."""
    return sum((far * min_jerk((times - a) / (b - a)) for a, b, far in ramps), 0.0 * times)


def between(one: np.ndarray, two: np.ndarray, share: np.ndarray) -> np.ndarray:
    out, way = np.tile(np.eye(4), (len(share), 1, 1)), min_jerk(share)
    out[:, :3, 3] = one[:3, 3] + way[:, None] * (two[:3, 3] - one[:3, 3])
    turns = Slerp([0.0, 1.0], Rotation.from_matrix([one[:3, :3], two[:3, :3]]))
    out[:, :3, :3] = turns(way).as_matrix()
    return out


def hand_path(
    times: np.ndarray, home: np.ndarray, holds: Iterable[Hold], bodies: Mapping[str, np.ndarray]
) -> np.ndarray:
    """From its home to each body, along with it, and home again."""
    out = np.tile(home, (len(times), 1, 1))
    for start, end, body, place in holds:
        way = bodies[body] @ place
        on = (times >= start) & (times <= end)
        out[on] = way[on]
        first, last = np.flatnonzero(on)[[0, -1]]
        come, go = (times - start) / LEAD_S + 1.0, (times - end) / LEAD_S
        for share, one, two in ((come, home, way[first]), (go, way[last], home)):
            during = (share > 0.0) & (share < 1.0) & ~on
            out[during] = between(one, two, share[during])
    return out


@cache
def laptop(
    lift: tuple[Ramp, ...],
    opened: tuple[Ramp, ...],
    hands: tuple[tuple[str, tuple[tuple[float, float, str], ...]], ...],
    *,
    seconds: float,
    rate_hz: float = 60.0,
    noise_m: float = 0.0005,
    least_deg: float = 0.0,
    part_of: str = "",
    closed_deg: float | None = None,
) -> Capture:
    """A base and a lid on its far edge, both movable, over a table."""
    times = np.arange(0.0, seconds, 1.0 / rate_hz)
    random = np.random.default_rng(5)
    up = course(times, *lift)
    base = np.array([at(0.5, 0.0, TOP_M + 0.0002 + each) for each in up])
    angle = np.radians(least_deg + course(times, *opened))
    turned = np.array([at(0.11, 0.0, 0.018, Rotation.from_rotvec([0.0, a, 0.0])) for a in angle])
    bodies = {"base": base, "lid": base @ turned}
    # On the lid's front edge from before, and on a side of the base.
    places = {"lid": at(-0.308, 0.0, 0.012), "base": at(0.0, -0.189, 0.012)}

    def stream(poses: np.ndarray, noise: float = noise_m) -> Stream:
        poses = poses.copy()
        poses[:, :3, 3] += noise * random.standard_normal((len(poses), 3))
        jitter = Rotation.from_rotvec(4.0 * noise * random.standard_normal((len(poses), 3)))
        turns = jitter * Rotation.from_matrix(poses[:, :3, :3])
        return Stream(times, poses[:, :3, 3], turns.as_quat(scalar_first=True))

    def thing(name: str, form: Form, poses: np.ndarray) -> TagObject:
        return TagObject(name, TagType.MOBILE, stream(poses), surface(form), name)

    flat = Form("base", (block((-0.11, -0.15, 0.0), (0.11, 0.15, 0.018)),))
    cover = Form("lid", (block((-0.22, -0.15, 0.0005), (0.0, 0.15, 0.008)),))
    table = np.tile(at(0.5, 0.0, TOP_M), (len(times), 1, 1))
    sensors = []
    for side, holds in hands:
        home = at(0.1, 0.28 if side == "left" else -0.28, TOP_M + 0.12)
        mirrored = at(0.0, 0.189, 0.012) if side == "left" else places["base"]
        placed = [(a, b, body, {**places, "base": mirrored}[body]) for a, b, body in holds]
        path = stream(hand_path(times, home, placed, bodies))
        sensors.append(Sensor(f"{side}_hand", "hand", side, f"{side}_arm", path, surface(HAND)))
    return Capture(
        "laptop",
        tuple(sensors),
        (
            thing("base", flat, base),
            replace(thing("lid", cover, bodies["lid"]), part_of=part_of, closed_deg=closed_deg),
            TagObject("table", TagType.FIXED, stream(table, 0.0), surface(TABLE), "table"),
        ),
    )


def steps(seen: Observation, hand: str = "right_hand") -> list[tuple[str, ...]]:
    """Names and objects, without rests and ways to and from."""
    ways = {"Reach", "ResumePosture", "Rest", "Withdraw"}
    return [(s.name, *s.objects) for s in seen.segments if s.ee == hand and s.name not in ways]


OPEN_AND_CLOSE = {
    "lift": (),
    "opened": ((1.8, 2.8, 90.0), (3.6, 4.6, -90.0)),
    "hands": (("right", ((1.0, 5.4, "lid"),)),),
    "seconds": 6.5,
}
IN_THE_AIR = {
    "lift": ((1.6, 2.4, 0.2), (6.0, 6.8, -0.2)),
    "opened": ((3.6, 4.6, 70.0),),
    "hands": (("left", ((1.0, 7.3, "base"),)), ("right", ((3.2, 5.2, "lid"),))),
    "seconds": 8.4,
}
BY_THE_LID = {
    "lift": ((1.6, 2.4, 0.2), (3.2, 4.0, -0.2)),
    "opened": ((4.8, 5.8, 80.0),),
    "hands": (("right", ((1.0, 6.4, "lid"),)),),
    "seconds": 7.4,
}
NEVER_CLOSED = OPEN_AND_CLOSE | {"least_deg": 40.0, "opened": ((1.8, 2.8, 50.0), (3.6, 4.6, -45.0))}


@pytest.mark.parametrize("rate_hz", [30.0, 100.0])
@pytest.mark.parametrize("noise_m", [0.0005, 0.0015])
def test_a_lid_on_a_movable_base_is_opened_and_closed(rate_hz: float, noise_m: float) -> None:
    seen = observe(laptop(**OPEN_AND_CLOSE, rate_hz=rate_hz, noise_m=noise_m))
    assert steps(seen) == [
        ("Touch", "lid"),
        ("Open", "lid", "base"),
        ("TouchWith", "lid", "base"),
        ("Close", "lid", "base"),
        ("TouchWith", "lid", "base"),
    ]
    (guide,) = seen.guides
    assert (guide.object, guide.base, guide.kind) == ("lid", "base", "hinge")
    assert guide.opened == pytest.approx(np.pi / 2, abs=0.05)
    assert guide.residual_m < 0.004
    assert [each.code for each in seen.notices].count("guide") == 1


def test_one_hand_holds_the_thing_in_the_air_while_the_other_opens_it() -> None:
    seen = observe(laptop(**IN_THE_AIR))
    assert steps(seen, "left_hand") == [
        ("Touch", "base"),
        ("Lift", "base"),
        ("Touch", "base"),
        ("Lower", "base", "table"),
        ("TouchWith", "base", "table"),
    ]
    assert steps(seen) == [("Touch", "lid"), ("Open", "lid", "base"), ("TouchWith", "lid", "base")]


def test_what_is_carried_by_its_part_is_the_whole() -> None:
    assert steps(observe(laptop(**BY_THE_LID))) == [
        ("Touch", "lid"),
        ("Lift", "base"),
        ("Touch", "base"),
        ("Lower", "base", "table"),
        ("TouchWith", "base", "table"),
        ("Open", "lid", "base"),
        ("TouchWith", "lid", "base"),
    ]


def test_what_is_never_closed_opens_from_where_the_shapes_or_the_capture_close_it() -> None:
    seen = observe(laptop(**NEVER_CLOSED))
    assert [name for name, *_ in steps(seen)[1:]] == ["Open", "TouchWith", "Close", "TouchWith"]
    assert max(each.opened for each in seen.guides) == pytest.approx(np.radians(90.0), abs=0.12)
    stated = observe(laptop(**NEVER_CLOSED, part_of="base", closed_deg=0.0))
    assert steps(stated) == steps(seen)
    assert max(each.opened for each in stated.guides) == pytest.approx(np.radians(90.0), abs=0.05)
    # From where it is most open, it closes first.
    away = observe(laptop(**NEVER_CLOSED, part_of="base", closed_deg=120.0))
    assert [name for name, *_ in steps(away)[1:]] == ["Close", "TouchWith", "Open", "TouchWith"]


def without_lid(capture: Capture) -> Capture:
    return replace(capture, objects=tuple(e for e in capture.objects if e.name != "lid"))


@pytest.mark.parametrize("change", [lambda each: each, without_lid])
def test_who_holds_the_base_does_what_they_would_without_the_part(
    change: Callable[[Capture], Capture],
) -> None:
    seen = observe(change(laptop(**IN_THE_AIR)))
    names = [name for name, *_ in steps(seen, "left_hand")]
    assert names == ["Touch", "Lift", "Touch", "Lower", "TouchWith"]
