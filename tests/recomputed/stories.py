"""The captures whose explanations are recomputed: each closed form, and some that are rarer."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache

import motions
import numpy as np
from flickering import flickering
from motions import doors, encounters, figure, shapes, uses
from motions.handled import BLOCK, Leg, Stage, beside, handle, place
from motions.paths import Still, pose
from motions.trials import Body, Trial
from scipy.spatial.transform import Rotation

from capar.model.capture import Capture, Role, Sensor, TagType
from capar.model.facts import Fact, Link, Moving, Resting, Touching
from capar.pipelines.explanation import Explained, measured_of
from capar.pipelines.observation import observe_measured
from capar_rules.engine.profiles import profile
from capar_rules.explain.explanation import Explainer, Explanation
from extractors.measure import measure
from recomputed.known import Known

Change = Callable[[tuple[Fact, ...], float], tuple[Fact, ...]]


@dataclass(frozen=True)
class Story:
    """A capture, how it is observed, and what its author wrote of it."""

    make: Callable[[], Trial]
    rules: str = "extended"
    steps: Mapping[str, Sequence[str]] | None = None
    """By end-effector, where they are not those of the trial's own truth."""

    change: Change | None = None
    """What befalls the measured facts."""


@dataclass(frozen=True)
class Told:
    """A story that was observed and explained, segment by segment."""

    seen: Explained
    known: tuple[Known, ...]
    explanations: tuple[Explanation, ...]


@cache
def told(name: str) -> Told:
    """A story's explanations, and what each is held against."""
    story = STORIES[name]
    trial = story.make()
    rules = profile(story.rules)
    measurements = measure(trial.capture)
    facts = measurements.facts
    if story.change:
        facts = story.change(facts, trial.capture.rate_hz)
    observation = observe_measured(trial.capture, replace(measurements, facts=facts), rules=rules)
    measured = measured_of(observation, measurements)
    explainer = Explainer(observation.facts, profile=rules, measured=measured)
    seen = Explained(observation, explainer, measurements)
    steps = story.steps or trial.truth.steps[story.rules]
    return Told(
        seen,
        tuple(Known(seen, facts, each, trial.capture, steps) for each in observation.segments),
        explainer.explain_all(observation.segments),
    )


def chattering(facts: tuple[Fact, ...], rate_hz: float) -> tuple[Fact, ...]:
    """Contact, motion and rest begin or end with a stroke too short to be one, and halt once."""
    hands = {each.ee for each in facts if isinstance(each, Link)}
    return tuple(part for each in facts for part in _chattered(each, hands))


def _chattered(fact: Fact, hands: set[str]) -> Iterator[Fact]:
    if not isinstance(fact, Touching | Moving | Resting) or fact.last - fact.first < 40:
        yield fact
        return
    if isinstance(fact, Touching) and fact.body not in hands:
        yield fact
        return
    if fact.first > 20:
        yield replace(fact, first=fact.first - 12, last=fact.first - 10)
    middle = (fact.first + fact.last) // 2
    yield replace(fact, last=middle - 3)
    yield replace(fact, first=middle)
    if isinstance(fact, Resting):
        yield replace(fact, first=fact.last + 10, last=fact.last + 12)


def glancing(trial: Trial, first_s: float, last_s: float) -> Trial:
    """The head is turned to the other side but for a glance."""
    head = _head(trial.capture)
    times = head.stream.times
    away = (times < first_s) | (times > last_s)
    turns = Rotation.from_quat(head.stream.orientations, scalar_first=True)
    about = Rotation.from_rotvec(np.where(away, np.pi, 0.0)[:, None] * np.array([0.0, 0.0, 1.0]))
    back = (about * turns).as_quat(scalar_first=True)
    stream = replace(head.stream, orientations=back)
    objects = tuple(
        replace(each, stream=stream) if each.name == head.name else each
        for each in trial.capture.objects
    )
    capture = _with_head(trial.capture, replace(head, stream=stream))
    return replace(trial, capture=replace(capture, objects=objects))


def acting_head(trial: Trial) -> Trial:
    """The head is an end-effector like the hand."""
    head = replace(_head(trial.capture), role=Role.ACTS)
    return replace(trial, capture=_with_head(trial.capture, head))


def _head(capture: Capture) -> Sensor:
    (head,) = [each for each in capture.sensors if each.end_effector == "head"]
    return head


def _with_head(capture: Capture, head: Sensor) -> Capture:
    sensors = (head if each.name == head.name else each for each in capture.sensors)
    return replace(capture, sensors=tuple(sensors))


def without(trial: Trial, what: str) -> Trial:
    """The same trial, of which nobody tracked that object."""
    kept = tuple(each for each in trial.capture.objects if each.name != what)
    return replace(trial, capture=replace(trial.capture, objects=kept))


def _bowl(ahead_m: float) -> Body:
    at = place(motions.WOMAN).translation + np.array([ahead_m, 0.0, 0.0])
    return Body("bowl", Still(pose(at)), shapes.bowl(0.11, 0.09), TagType.MOBILE, mass_kg=0.4)


def pour_on() -> Trial:
    """A block is held leant over a bowl, and moved on a little so."""
    stage = Stage(shapes.box(*BLOCK), beside(motions.WOMAN), (_bowl(0.3),), kind="jug")
    legs = (
        uses.UP,
        Leg((0.25, 0.0, 0.0)),
        Leg(turn=(0.0, 1.2, 0.0)),
        Leg((0.06, 0.0, 0.0)),
        Leg(turn=(0.0, -1.2, 0.0)),
        Leg((-0.31, 0.0, 0.0)),
        uses.DOWN,
    )
    turned = ("Pour", "Touch", "Pour", "Touch", "Pour", "Touch")
    steps = (*uses.LIFTED, "Carry", "Touch", *turned, "Carry", *uses.LOWERED)
    return handle(motions.WOMAN, "pour_on", legs, steps, stage)


def pour_inside() -> Trial:
    """A tumbler is leant over within a bowl, more than half of it below the rim."""
    tumbler = (0.03, 0.03, 0.12)
    out = tumbler[1] / 2 - figure.GRIP_DEPTH + figure.thickness(motions.WOMAN)
    grip = pose((0.0, -out, 0.12), beside(motions.WOMAN).rotation)
    stage = Stage(shapes.box(*tumbler), grip, (_bowl(0.0),), held=True, height_m=0.22, kind="glass")
    over, back = Leg(turn=(-0.6, 0.0, 0.0)), Leg(turn=(0.6, 0.0, 0.0))
    legs = (Leg((0.0, 0.0, -0.195)), over, back, Leg((0.0, 0.0, 0.195)))
    steps = ("Touch", "Lower", "Touch", "Pour", "Touch", "Pour", "Touch", "Raise", "Touch")
    return handle(motions.WOMAN, "pour_inside", legs, steps, stage)


def kicked_off() -> Trial:
    """A foot meets a ball for a moment that counts in this trial as a contact."""
    trial = encounters.kick(motions.WOMAN, pushes_s=0.015)
    return replace(trial, capture=replace(trial.capture, contact_minimum_s=0.0))


DRINK = ("Reach", "MoveObjTo", "Drink", "MoveObjTo", "TouchWith", "ResumePosture")
LIFT = ("Reach", "Touch", "Lift", "Lower", "TouchWith", "ResumePosture")
MEANT: dict[str, dict[str, Sequence[str]]] = {
    "drink_from_mug": {"right_hand": DRINK},
    "pick_up_with_both_hands": {"left_hand": LIFT, "right_hand": LIFT},
    "slide_object": {"right_hand": ("Reach", "Push")},
    "touch_with": {"right_hand": ("Lower", "TouchWith")},
    "move_obj": {"right_hand": ("Pull",)},
    "move_obj_to": {"right_hand": ("Lower", "TouchWith")},
    "acting_head": {
        "head": ("PostureChange", "LookAt", "PostureChange"),
        "right_hand": ("Reach", "Touch", "ResumePosture"),
    },
    "put_down": {
        "right_hand": (*uses.LIFTED, "Carry", "Touch", "PutDown", "Touch", "ResumePosture")
    },
}
"""Steps by what the words mean, where the trial's own truth has the published, general ones."""

UP_AND_DOWN = ("Reach", "TouchWith", "MoveObj", "TouchWith", "ResumePosture")
PUBLISHED = ("Reach", "MoveObjTo", "MoveObj", "MoveObjTo", "TouchWith", "ResumePosture")
BY_THE_THESIS: dict[str, dict[str, Sequence[str]]] = {
    "drink_from_mug": {"right_hand": PUBLISHED},
    "carry": {"right_hand": UP_AND_DOWN},
    "throw": {"right_hand": ("Unknown", "Unknown")},
    "kick": {"right_foot": ("Unknown",)},
}
"""The same by the seven published primitives, of which none is a throw or a kick."""


OPENED = (
    doors.open_and_close_drawer,
    doors.open_and_close_drawer_at_once,
    doors.open_and_close_door,
)
"""What is closed in the first frame, as the recomputation has it."""


def _stories() -> Iterator[tuple[str, Story]]:
    thesis = (
        motions.drink_from_mug,
        motions.pick_up_with_both_hands,
        motions.slide_object,
        motions.touch_cycle,
        motions.touch_from_rest,
    )
    rows = (
        motions.hit,
        motions.touch,
        motions.touch_with,
        motions.move_obj,
        motions.move_obj_to,
        motions.resume_posture,
    )
    once = (*rows, motions.roll_object, *uses.USES, *encounters.ENCOUNTERS, *OPENED)
    for motion in thesis:
        for performer in (motions.TALL_MAN, motions.CHILD):
            yield (
                f"{motion.__name__}_{performer.name}",
                Story(_by(motion, performer), steps=MEANT.get(motion.__name__)),
            )
    for motion in (*once, motions.stand_on_one_leg):
        if motion is not encounters.kick:
            yield (
                motion.__name__,
                Story(_by(motion, motions.WOMAN), steps=MEANT.get(motion.__name__)),
            )
    yield "kick", Story(kicked_off)
    yield "hand_over", Story(motions.hand_over)
    drink, carry, cycle = (
        _by(each, motions.WOMAN)
        for each in (motions.drink_from_mug, uses.carry, motions.touch_cycle)
    )
    yield "flickering", Story(drink, change=flickering, steps=MEANT["drink_from_mug"])
    yield "chattering", Story(drink, change=chattering, steps=MEANT["drink_from_mug"])
    yield "pour_on", Story(pour_on)
    yield "pour_inside", Story(pour_inside)
    yield "glancing", Story(lambda: glancing(drink(), 0.6, 1.0), steps=MEANT["drink_from_mug"])
    yield "acting_head", Story(lambda: acting_head(cycle()), steps=MEANT["acting_head"])
    yield "put_down", Story(lambda: without(carry(), "table"), steps=MEANT["put_down"])
    for motion in (motions.drink_from_mug, uses.carry, encounters.throw, encounters.kick):
        steps = BY_THE_THESIS[motion.__name__]
        yield f"{motion.__name__}_by_the_thesis", Story(_by(motion, motions.WOMAN), "thesis", steps)


def _by(motion: Callable[..., Trial], performer: motions.Performer) -> Callable[[], Trial]:
    return lambda: motion(performer)


STORIES: dict[str, Story] = dict(_stories())
