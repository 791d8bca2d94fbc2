"""A motion as a capture, so that it can be observed again."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from capar.body import scenes
from capar.body.performing import Performance
from capar.body.recording import Truth, record, write_bundle
from capar.body.sensors import PERFECT, Tracker
from capar.model.capture import Agent, Capture
from capar.regeneration.motions import Motion
from capar.regeneration.scenes import Scene


def capture_of(
    motion: Motion, *, name: str, agent: str, tracker: Tracker = PERFECT, seed: int = 0
) -> Capture:
    """What a tracker would have recorded of a motion.

    Args:
        motion: What was done.
        name: Of the capture.
        agent: Name of the performer.
        tracker: Its faults; none, unless stated.
        seed: Of its faults.
    """
    plan = motion.plan
    measures = plan.human.measures
    kind = "child" if measures.adult_share < 0.5 else measures.adult
    stated = {each: round(value, 4) for each, value in measures.values.items()}
    made = Performance(
        human=plan.human,
        scene=scenes.Scene(plan.scene.things),
        script=(),
        times=np.array(plan.source.times),
        motion=motion.postures,
        scenes=plan.things,
        phases=(),
        gazes=plan.looks,
        looks=(),
        slip_m={},
    )
    return record(
        made,
        name=name,
        seed=seed,
        tracker=tracker,
        sensors=(*(f"{side}_hand" for side in plan.hands), "head"),
        agent=Agent(agent, kind, {"age": measures.age, **stated}),
    )


def renamed(capture: Capture, names: Mapping[str, str]) -> Capture:
    """The capture with other names of its objects."""
    objects = tuple(replace(each, name=names.get(each.name, each.name)) for each in capture.objects)
    return replace(capture, objects=objects)


def scene_after(motion: Motion, names: Mapping[str, str], scene: Scene) -> Scene:
    """The scene as a motion leaves it.

    Args:
        motion: What was done.
        names: The scene's names of the things by those that the motion has.
        scene: As it was before.
    """
    plan = motion.plan
    left = dict(scene.things)
    for name, thing in plan.scene.things.items():
        own = names[name]
        ahead = plan.things[name].rotation[-1].apply([1.0, 0.0, 0.0])
        heading = float(np.arctan2(ahead[1], ahead[0]))
        x, y, z = (float(value) for value in plan.things[name].translation[-1])
        left[own] = replace(thing, name=own, place=(x, y, z), heading=heading)
    return replace(scene, things=left, place=plan.scene.place, heading=plan.scene.heading)


def write_motion(motion: Motion, capture: Capture, folder: Path) -> None:
    """Write a motion's capture as a bundle, with what was planned as the truth beside it."""
    write_bundle(capture, truth_of_motion(motion), folder)


def truth_of_motion(motion: Motion) -> Truth:
    """What was planned, as the truth of a motion."""
    times = motion.plan.source.times
    contacts = sorted(
        (first, second, float(times[a]), float(times[b]))
        for first, second, a, b in _contacts(motion)
    )
    goals = motion.plan.goals.items()
    moves = tuple((n, float(times[g[0].frame]), float(times[g[-1].frame])) for n, g in goals)
    phases = tuple(
        (f"{each.ee}_{each.index}_{each.name}", float(times[each.first]), float(times[each.last]))
        for each in motion.plan.source.observation.segments
    )
    return Truth(tuple(contacts), moves, phases, ())


def _contacts(motion: Motion) -> Iterator[tuple[str, str, int, int]]:
    for hold in motion.plan.source.holds:
        yield f"{hold.side}_hand", hold.thing, hold.first, hold.last
    for meeting in motion.plan.source.meetings:
        yield meeting.thing, meeting.part, meeting.first, meeting.last
