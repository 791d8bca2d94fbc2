"""Answers about recordings agree with what numpy computes from their poses, without any rules.

Each figure is computed from the positions and orientations of the recording, in the plainest way
that there is, and compared with a margin for filtering and for borders that are merged.
"""

from collections.abc import Iterable, Iterator

import numpy as np
import pytest
import trimesh
from competency import QUERIES, World
from jaxtyping import Bool, Float

from capar.model import geometry
from capar.model.capture import Capture, Shape, Stream, TagObject
from kb.actionary import Actionary
from kb.store.sparql import prepare

BORDER_S = 0.15
"""How far a border may be from where the poses have it [s]: the time within which events merge."""

LEAN_RAD = 0.5236
"""Beyond this angle from upright a thing leans [rad]."""


@pytest.fixture(scope="module")
def actionary(world: World) -> Iterator[Actionary]:
    with Actionary.in_memory() as fresh:
        for seen in world.seen:
            fresh.add(seen)
        yield fresh


@pytest.fixture
def kitchen(world: World) -> list[Capture]:
    if not world.kitchen:
        pytest.skip("there are no recordings")
    return [world.captures[name] for name in sorted(world.kitchen)]


def rows_of(actionary: Actionary, name: str) -> list[dict[str, object]]:
    return list(actionary.store.ask(prepare(QUERIES[name])).plain())


def thing(capture: Capture, name: str) -> TagObject:
    return next(each for each in capture.objects if each.name == name)


def stream(capture: Capture, name: str) -> Stream:
    return next(e.stream for e in (*capture.sensors, *capture.objects) if e.name == name)


def shape(capture: Capture, name: str) -> Shape:
    found = thing(capture, name).shape
    assert found is not None
    return found


def during(
    capture: Capture, intervals: Iterable[tuple[object, object]]
) -> Bool[np.ndarray, "frames"]:
    """Which frames are in one of some intervals [s]."""
    holds = np.zeros(len(capture.times), dtype=bool)
    for start, end in intervals:
        after = capture.times >= float(str(start)) - 1e-6
        holds |= after & (capture.times <= float(str(end)) + 1e-6)
    return holds


def agree(
    capture: Capture,
    told: Bool[np.ndarray, "frames"],
    plain: Bool[np.ndarray, "frames"],
    known: Bool[np.ndarray, "frames"],
    *,
    within_s: float = BORDER_S,
) -> bool:
    """Whether what is told and what is computed differ only near the borders of the computed."""
    edges = capture.times[np.flatnonzero(np.diff(plain.astype(int))) + 1]
    apart = capture.times[(told != plain) & known]
    return all(np.min(np.abs(edges - time), initial=np.inf) <= within_s for time in apart)


def tilt(of: Stream) -> Float[np.ndarray, "frames"]:
    """Angle between the axis that is upright at first and the vertical [rad]; NaN where lost."""
    first = int(np.flatnonzero(~of.lost)[0])
    up = geometry.rotations(of.orientations[first]).inv().apply([0.0, 0.0, 1.0])
    angle = np.full(len(of.times), np.nan)
    turned = geometry.rotations(of.orientations[~of.lost]).apply(up)
    angle[~of.lost] = np.arccos(np.clip(turned[:, 2], -1.0, 1.0))
    return angle


def sees(capture: Capture, name: str, time_s: float) -> bool:
    """Whether the line of sight of the head meets a thing at a time, whatever is between."""
    frame = int(np.argmin(np.abs(capture.times - time_s)))
    eye = next(each for each in capture.sensors if each.end_effector == "head")
    head, pose = eye.stream.pose(frame), stream(capture, name).pose(frame)
    start = pose.inv().apply(head.apply(np.array(eye.eye)))
    way = pose.rotation.inv().apply(head.rotation.apply(np.array(eye.gaze)))
    surface = shape(capture, name)
    mesh = trimesh.Trimesh(surface.vertices, surface.faces)
    return bool(mesh.ray.intersects_any([start], [way])[0])


def away(of: Stream, by_m: float) -> Bool[np.ndarray, "frames"]:
    """Where a body is away from where it is in the first and in the last half second."""
    ends = [of.times <= 0.5, of.times >= of.times[-1] - 0.5]
    rests = [np.nanmedian(of.positions[end], axis=0) for end in ends]
    far = [np.linalg.norm(of.positions - rest, axis=1) > by_m for rest in rests]
    return np.asarray(far[0] & far[1])


def test_the_whisk_is_up_and_the_bottle_tilted_when_it_is_told(
    kitchen: list[Capture], actionary: Actionary
) -> None:
    rows = rows_of(actionary, "held while tilted")
    for capture in kitchen:
        bottle, whisk = stream(capture, "bottle"), stream(capture, "whisk")
        plain = (tilt(bottle) > LEAN_RAD) & away(whisk, 0.03)
        told = [(r["from"], r["to"]) for r in rows if r["capture"] == capture.name]
        known = ~bottle.lost & ~whisk.lost
        assert plain.any()
        assert agree(capture, during(capture, told), plain, known)


def test_the_whisk_alone_was_in_the_bowl(kitchen: list[Capture], actionary: Actionary) -> None:
    rows = actionary.ask("arrangements", arrangement="inside", object="bowl")
    for capture in kitchen:
        bowl = thing(capture, "bowl")
        corners = shape(capture, "bowl").vertices
        middle = corners.mean(axis=0)
        axes = np.linalg.svd(corners - middle)[2]
        half = np.abs((corners - middle) @ axes.T).max(axis=0)
        told = [(r["begins"], r["ends"]) for r in rows if r["observation"] == capture.name]
        share = {}
        for name in ("whisk", "bottle", "left_hand", "right_hand"):
            body = stream(capture, name)
            own = next((e.shape for e in capture.objects if e.name == name), None)
            points = np.zeros((1, 3))
            if own is not None:
                outer = own.vertices - own.vertices.mean(axis=0)
                points = own.vertices.mean(axis=0) + np.concatenate([outer, 0.5 * outer, points])
            known = ~body.lost & ~bowl.stream.lost
            within = np.zeros((len(capture.times), len(points)), dtype=bool)
            for frame in np.flatnonzero(known):
                turn = geometry.rotations(body.orientations[frame])
                world = turn.apply(points) + body.positions[frame]
                back = geometry.rotations(bowl.stream.orientations[frame]).inv()
                local = back.apply(world - bowl.stream.positions[frame]) - middle
                within[frame] = (np.abs(local @ axes.T) <= half).all(axis=1)
            share[name] = within.mean(axis=1)
        assert all((share[name] < 0.5).all() for name in share if name != "whisk")
        inside = share["whisk"] >= 0.5
        assert inside.any()
        assert told and np.mean(during(capture, told)[inside]) > 0.9
        assert np.mean(share["whisk"][during(capture, told)] > 0.3) > 0.9


def test_the_bottle_is_at_the_height_of_the_table_when_they_touch(
    kitchen: list[Capture], actionary: Actionary
) -> None:
    rows = rows_of(actionary, "in touch")
    for capture in kitchen:
        bottle = stream(capture, "bottle")
        height = bottle.positions[:, 2] - np.nanmedian(bottle.positions[bottle.times < 0.5, 2])
        told = [(r["a"], r["b"]) for r in rows if r["capture"] == capture.name]
        assert len(told) >= 2
        plain = height < 0.015
        assert agree(capture, during(capture, told), plain, ~bottle.lost)


def test_a_thing_is_told_to_be_moved_as_long_as_it_is_away(
    kitchen: list[Capture], actionary: Actionary
) -> None:
    rows = actionary.ask("held", effector="hand")
    for capture in kitchen:
        for ee, name in (("right_hand", "whisk"), ("left_hand", "bottle")):
            body = stream(capture, name)
            up = (away(body, 0.02) | body.lost) & (capture.times > 1.0)
            (row,) = (
                r
                for r in rows
                if (r["observation"], r["ee"], r["object"]) == (capture.name, ee, name)
            )
            assert row["moved"] == pytest.approx(up.sum() / capture.rate_hz, abs=0.7)
            assert float(str(row["moved"])) <= float(str(row["held"])) <= float(str(row["touched"]))


def test_the_highest_speed_of_a_reach_is_that_of_the_poses(
    world: World, actionary: Actionary
) -> None:
    compared = 0
    for row in actionary.ask("speeds", action="Reach", effector="hand"):
        name, ee, _ = str(row["address"]).split("/")
        if name not in world.captures or row["highest"] is None:
            continue
        capture = world.captures[name]
        body = stream(capture, ee)
        start, end = float(str(row["begins"])), float(str(row["ends"]))
        clock = np.arange(start, end + 1e-9, 1 / 60.0)
        if len(clock) < 12 or body.lost[during(capture, [(start - 0.1, end + 0.1)])].any():
            continue
        places = np.stack(
            [np.interp(clock, capture.times, axis) for axis in body.positions.T], axis=1
        )
        steps = np.linalg.norm(places[4:] - places[:-4], axis=1) * 15.0  # over 67 ms
        assert float(str(row["highest"])) == pytest.approx(steps.max(), rel=0.15, abs=0.03)
        way = np.linalg.norm(np.diff(places[::4], axis=0), axis=1).sum()
        assert float(str(row["way"])) == pytest.approx(way, rel=0.15, abs=0.03)
        compared += 1
    assert compared >= 1


def test_the_line_of_sight_meets_what_was_looked_at_before_it_was_grasped(
    world: World, actionary: Actionary
) -> None:
    rows = [r for r in actionary.ask("looked_before") if r["observation"] in world.captures]
    assert rows
    for row in rows:
        capture = world.captures[str(row["observation"])]
        body = thing(capture, str(row["object"]))
        looked, until = float(str(row["looked"])), float(str(row["until"]))
        assert sees(capture, body.name, 0.5 * (looked + until))
        assert sees(capture, body.name, looked + 0.02)
        grasped = float(str(row["grasped"]))
        assert row["seconds"] == pytest.approx(grasped - looked)
        rest = np.median(body.stream.positions[capture.times < 0.3], axis=0)
        moves = np.linalg.norm(body.stream.positions - rest, axis=1) > 0.03
        assert grasped <= capture.times[-1] and moves[capture.times >= grasped].any()
