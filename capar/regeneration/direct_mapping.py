"""Direct mapping (thesis 3.2 to 3.6), the baseline: no PARs, no planning."""

import itertools
from collections.abc import Mapping

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.human import Human
from capar.model.geometry import transforms
from capar.regeneration import planning
from capar.regeneration.body_frames import BodyFrames, body_frames, head_path, head_ratio, rest_pose
from capar.regeneration.goals import Goal
from capar.regeneration.grips import Grip, Turn, recorded_grip
from capar.regeneration.motion import Motion, perform_plan
from capar.regeneration.planning import SETTLE_S, Plan
from capar.regeneration.quality import Measure, Quality, performed_hands, quality
from capar.regeneration.sources import Hold, Meeting, Source
from capar.regeneration.styles import SHORT_M, arc_shares, own_style

HEAD_SHARE = 0.1  # How firmly the head is kept on its way where nothing meets it [1].


def map_directly(source: Source, human: Human) -> tuple[Motion, Quality]:
    """Let a body do what was recorded, in the recorded scene, by direct mapping.

    Returns:
        The motion, and its gates; none of them is a condition here.
    """
    motion = perform_plan(mapped_plan(source, human))
    return motion, quality(motion)


def mapped_plan(source: Source, human: Human) -> Plan:
    """Where hands, objects, head and gaze are at every frame by direct mapping."""
    scene = source.scene
    old, new = body_frames(source.human, scene), body_frames(human, scene)
    head = head_path(source, old, new)
    things = {name: _thing_path(source, old, new, head, name) for name in source.paths}
    hands = {side: _hand_path(source, old, new, things, side) for side in source.hands}
    meeting = planning.around(source, source.meetings, SETTLE_S)
    return Plan(
        source=source,
        scene=scene,
        human=human,
        frames=new,
        goals={name: goals for name in things if (goals := _goals(source, things, name))},
        grips=tuple(Grip(h, recorded_grip(source, h), Turn(), 0.0) for h in source.holds),
        detours={},
        hands=hands,
        style=own_style(source),
        grasps={side: np.ones(len(source.times)) for side in hands},
        things=things,
        head=head,
        firmness=np.maximum(meeting, HEAD_SHARE),
        looks=planning.looks(source, things, head),
        notes=source.notes,
    )


def axis_mapped(
    path: Float[np.ndarray, "frames 3"], start: Float[np.ndarray, "3"], goal: Float[np.ndarray, "3"]
) -> Float[np.ndarray, "frames 3"]:
    """A path between other ends, axis by axis (thesis 3.4.2, eq. 3.3) [m].

    Along an axis on which the ends of the path are near each other the quotient of the equation
    has no meaning: there the displacements of both ends are added, by the share of the path.

    Args:
        path: As it was recorded [m].
        start: Where the new path begins [m].
        goal: Where it ends [m].
    """
    gone, wanted = path[-1] - path[0], goal - start
    shares = arc_shares(path)[:, None]
    added = path + (start - path[0]) * (1.0 - shares) + (goal - path[-1]) * shares
    wide = np.abs(gone) > SHORT_M
    scaled = (path - path[0]) / np.where(wide, gone, 1.0) * wanted + start
    return np.where(wide, scaled, added)


def _thing_path(
    source: Source, old: BodyFrames, new: BodyFrames, head: RigidTransform, name: str
) -> RigidTransform:
    """``T_world_thing``: where it was recorded, and at the new head where it met the head."""
    recorded = source.paths[name]
    spots = recorded.translation.copy()
    own = [meeting for meeting in source.meetings if meeting.thing == name]
    for meeting in own:
        part = slice(meeting.first, meeting.last + 1)
        local = (source.eyes[part].inv() * recorded[part]).translation * head_ratio(old, new)
        spots[part] = head[part].apply(local)
    for first, last in _between(source, own, name):
        ends = spots[first], spots[last]
        spots[first : last + 1] = axis_mapped(recorded.translation[first : last + 1], *ends)
    return RigidTransform.from_components(spots, recorded.rotation)


def _between(source: Source, own: list[Meeting], name: str) -> list[tuple[int, int]]:
    """Intervals in which an object is on its way to the head or from it."""
    out = []
    for hold in source.holds:
        met = [m for m in own if hold.first <= m.first <= hold.last]
        if hold.thing == name and met:
            edges = [hold.first, *(e for m in met for e in (m.first, min(m.last, hold.last)))]
            pairs = itertools.pairwise([*edges, hold.last])
            out += [(a, b) for number, (a, b) in enumerate(pairs) if number % 2 == 0 and b > a]
    return out


def _hand_path(
    source: Source,
    old: BodyFrames,
    new: BodyFrames,
    things: Mapping[str, RigidTransform],
    side: str,
) -> RigidTransform:
    """``T_world_hand``: on what it holds as it was recorded, and led from hold to hold."""
    recorded, last = source.hands[side].path, len(source.times) - 1
    spots = recorded.translation.copy()
    turns = recorded.rotation.as_quat()
    holds = [hold for hold in source.holds if hold.side == side]
    for hold in holds:
        part = slice(hold.first, hold.last + 1)
        thing = things[hold.thing][part]
        held = thing * source.paths[hold.thing][part].inv() * recorded[part]
        spots[part], turns[part] = held.translation, held.rotation.as_quat()
    for before, after in zip([None, *holds], [*holds, None], strict=True):
        first = before.last if before else 0
        final = after.first if after else last
        if final > first:
            start = spots[first] if before else rest_pose(source, old, new, side, 0).translation
            goal = spots[final] if after else rest_pose(source, old, new, side, last).translation
            part = slice(first, final + 1)
            spots[part] = axis_mapped(recorded.translation[part], start, goal)
    return RigidTransform.from_components(spots, Rotation.from_quat(turns))


def _goals(source: Source, things: Mapping[str, RigidTransform], name: str) -> list[Goal]:
    """Where an object is at each event, for the gates."""
    spans: list[Hold | Meeting] = [*source.holds, *source.meetings]
    own = [span for span in spans if span.thing == name]
    frames = sorted({frame for span in own for frame in (span.first, span.last)})
    return [Goal(name, frame, things[name][frame], "as recorded") for frame in frames]


def departures(motion: Motion) -> tuple[Measure, ...]:
    """The largest distance of each hand and each moved object from its recorded place [mm].

    The capture's own poses are compared, hands by the frame along the axes of their hulls. In
    the recorded scene they say how exactly the recorded body does again what it did.
    """
    plan = motion.plan
    capture, hands, rows = plan.source.capture, performed_hands(motion), []
    for side, hand in plan.source.hands.items():
        stream = capture.sensor(hand.sensor).stream
        known = np.flatnonzero(~stream.lost)
        recorded = transforms(stream.positions[known], stream.orientations[known]) * hand.frame.pose
        rows.append((f"{side} hand", hands[side].translation[known], recorded.translation, known))
    for name in plan.goals:
        stream = capture.tag_object(name).stream
        known = np.flatnonzero(~stream.lost)
        rows.append((name, plan.things[name].translation[known], stream.positions[known], known))
    out = []
    for name, performed, spots, known in rows:
        apart = np.linalg.norm(performed - spots, axis=1)
        worst = int(apart.argmax())
        far_mm, frame = 1e3 * float(apart[worst]), int(known[worst])
        out.append(Measure("from the recorded way", far_mm, "mm", frame, name))
    return tuple(out)
