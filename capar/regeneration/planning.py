"""From a recorded performance to what another body is to do in another scene."""

import itertools
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from capar.body.human import Human
from capar.model.capture import TagType
from capar.regeneration import attending
from capar.regeneration.body_frames import BodyFrames
from capar.regeneration.drafts import MOST_TURNS, Beyond, Draft, check_companions, check_stance
from capar.regeneration.errors import PlanError
from capar.regeneration.fastening import resized_with
from capar.regeneration.forces.flights import flight_notes, flights
from capar.regeneration.grips import Grip
from capar.regeneration.hand_paths import Care, hand_paths
from capar.regeneration.path_mapping import Detour
from capar.regeneration.scenes import Scene, mobile, moved, raised, resized, taken_with
from capar.regeneration.solving import Targets, vectors
from capar.regeneration.sources import Source
from capar.regeneration.styles import Style, own_style
from capar.regeneration.thing_goals import Goal

FEW_TURNS = 6
"""Turns of a grip that are tried where another place or a remedy is sought."""

TOSS_TURNS = 24
"""Turns of a grip that are tried for a throw and a catch, each of which takes seconds [1]."""

MOST_CHANGES, MOST_GRIPPED, MOST_PERFORMED = 24, 6, 2
"""Of a toss so many other places, and so many remedies, are tried by a few postures with palms
that turn freely; of those that come near, so many by turns of the grips; and so many are performed
[1]."""

STEPS_M = (
    (0.05, 0.0), (-0.05, 0.0), (0.1, 0.0), (-0.1, 0.0), (0.0, -0.1), (0.0, 0.1),
    (0.1, -0.1), (0.1, 0.1), (-0.1, -0.1), (-0.1, 0.1), (0.2, 0.0), (-0.2, 0.0),
)  # fmt: skip
"""Places that are tried, from the given one ahead and to the left [m]."""

NEARER_M = (0.05, 0.1, 0.15, 0.2, 0.3)
HIGHER_M = (0.1, -0.1, 0.2, -0.2, 0.4, -0.4)
DRAWN_M = (0.1, 0.2, 0.3)
"""Remedies that are tried where something is out of reach [m]: standing, fixed things, others."""

BOTH_M = 0.2
"""How much nearer things are where fixed ones are higher or lower besides [m]."""

TALLER_M = 0.02
"""A recorded body that is so much taller is tried, too [m]."""

TOLD_M = 0.005
"""A correction of a grip that is told [m]."""

SMALLER = 0.7
"""Likewise the size of what can be moved [1]."""


Performs = Callable[[Draft], bool]
"""Whether the motion of a draft passes every gate."""


class BeyondReachError(PlanError):
    """A palm does not come to where it is to be, however it is turned."""

    def __init__(self, beyond: Beyond) -> None:
        super().__init__(beyond.sentence)
        self.frame = beyond.frame


@dataclass
class Search:
    """Finds which other place or remedy does; of a toss it tries no more than ``MOST_...``."""

    source: Source
    style: Style
    frames: frozenset[int] = frozenset()
    """Frames of a toss at which reach is tried first."""

    performs: Performs | None = None
    """Tries the motion of a toss that is in reach; left out, reach is enough."""

    changes: int = 0
    gripped: int = 0
    performed: int = 0

    def finds(self, scene: Scene, human: Human, most: int = FEW_TURNS) -> bool:
        """Whether a body does it from just there, as far as that is tried.

        Args:
            scene: Where.
            human: Who performs.
            most: Turns of a grip that are tried, of a toss no more than usual here.
        """
        if not self.source.tosses:
            return is_possible(self.source, scene, human, most)
        if self.changes == MOST_CHANGES or self.gripped == MOST_GRIPPED:
            return False
        self.changes += 1
        try:
            check_stance(scene, human)
            draft = Draft(self.source, scene, human, self.style)
            if draft.beyond(self.frames):
                return False
            self.gripped += 1
            grips, missed = draft.reachable_grips(FEW_TURNS)
        except PlanError:
            return False
        if missed is not None or draft.pressed:
            return False
        draft.grips = tuple(grips)
        return self.performs is None or self._performs(draft, self.performs)

    def _performs(self, draft: Draft, performs: Performs) -> bool:
        if self.performed == MOST_PERFORMED:
            return False
        self.performed += 1
        return performs(draft)


@dataclass(frozen=True, eq=False)
class Plan:
    """Where hands, things, head and gaze are to be at every frame."""

    source: Source
    scene: Scene
    human: Human
    frames: BodyFrames
    goals: Mapping[str, list[Goal]]
    grips: tuple[Grip, ...]
    detours: Mapping[tuple[str, int], Detour]
    """By side and the free stretch's first frame."""

    hands: Mapping[str, RigidTransform]
    """``T_world_hand`` by side at every frame, the frame on the hand."""

    style: Style
    grasps: Mapping[str, Float[np.ndarray, "frames"]]
    """How firmly each hand is kept there [1], 1 being usual in a hold."""

    things: Mapping[str, RigidTransform]
    head: RigidTransform
    firmness: Float[np.ndarray, "frames"]
    looks: Float[np.ndarray, "frames 3"]
    notes: tuple[str, ...]

    def targets(self) -> list[Targets]:
        """Where everything is to be at each frame."""
        palms = {s: vectors(path * self.frames.palms[s]) for s, path in self.hands.items()}
        head = vectors(self.head)
        return [
            Targets(
                {side: rows[frame] for side, rows in palms.items()},
                {side: float(firm[frame]) for side, firm in self.grasps.items()},
                head[frame],
                float(self.firmness[frame]),
                self.looks[frame],
            )
            for frame in range(len(head))
        ]


def plan(source: Source, scene: Scene, human: Human, *, care: Care | None = None) -> Plan:
    """Decide what a body is to do, before anything moves.

    Args:
        source: The recorded performance.
        scene: Where it is performed.
        human: Who performs.
        care: How free hands keep from what they do not touch.

    Raises:
        PlanError: Something is out of reach or cannot be put down; the message says what would
            help.
    """
    return led(reachable(source, scene, human), care or Care())


def reachable(
    source: Source,
    scene: Scene,
    human: Human,
    style: Style | None = None,
    watched: frozenset[int] = frozenset(),
    performs: Performs | None = None,
) -> Draft:
    """Goals, and grips that reach them, from where it stands or, unless it stays, from nearby.

    Args:
        source: The recorded performance.
        scene: Where it is performed.
        human: Who performs.
        style: How it is done; as it was recorded, unless stated.
        watched: Frames at which reach is tried besides the usual ones; without any grip that
            reaches there, nothing else is sought that would help.
        performs: Tries the motion of what would help a toss; left out, reach is enough.

    Raises:
        PlanError: As ``plan`` says.
    """
    style = style or own_style(source)
    check_companions(source, scene, human)
    pressed: Draft | None = None
    frames = frozenset(frame for toss in source.tosses for frame in (toss.first, toss.last))
    try:
        found = _draft(source, scene, human, style, watched)
        if not found.pressed:
            return found
        pressed, why = found, found.pressed[0]
    except BeyondReachError as error:
        frames |= {error.frame}
        why = str(error)
    except PlanError as error:
        why = str(error)
    places = Search(source, style, frames)
    for ahead_m, aside_m in () if scene.stays else STEPS_M:
        nearby = beside(scene, ahead_m, aside_m)
        if places.finds(nearby, human):
            found = _draft(source, nearby, human, style, watched)
            way = f"{ahead_m:+.2f} m ahead and {aside_m:+.2f} m to its left"
            found.told.append(f"stands {way} of the given place, since there {why}")
            return found
    if pressed:
        pressed.told += [f"whatever the grip, {told}" for told in pressed.pressed]
        return pressed
    if watched:
        raise PlanError(why)
    raise PlanError(f"{why}; {_remedy(Search(source, style, frames, performs), scene, human)}")


def why_unreachable(source: Source, scene: Scene, human: Human, style: Style) -> str | None:
    """Why a body does not come to every goal from just there; None where it does.

    Args:
        source: The recorded performance.
        scene: Where it is performed.
        human: Who performs.
        style: How it is done.
    """
    try:
        found = _draft(source, scene, human, style, frozenset())
    except PlanError as error:
        return str(error)
    return found.pressed[0] if found.pressed else None


def led(draft: Draft, care: Care) -> Plan:
    """A plan with the ways of free hands, so careful.

    Args:
        draft: With grips that reach.
        care: How free hands keep from what they do not touch.
    """
    source, scene = draft.source, draft.scene
    held = {grip.hold: grip.pose for grip in draft.grips}
    hands, detours = hand_paths(
        source, scene, draft.old, draft.new, held, draft.things, care=care, style=draft.style
    )
    humans, kind = (source.human, draft.new.human), draft.style.force
    things, hands, launched = flights(source, scene, humans, draft.things, hands, kind)
    events = {goal.frame for several in draft.goals.values() for goal in several}
    grasps = attending.grasps(source, care.firm_s, events, care.weight)
    return Plan(
        source, scene, draft.new.human, draft.new, draft.goals, draft.grips, detours, hands,
        draft.style, grasps, things, draft.head, draft.firmness, draft.looks,
        (*_notes(source, draft.grips, draft.goals), *draft.told, *flight_notes(source, launched)),
    )  # fmt: skip


def _draft(
    source: Source, scene: Scene, human: Human, style: Style, watched: frozenset[int]
) -> Draft:
    check_stance(scene, human)
    draft = Draft(source, scene, human, style, watched)
    if source.tosses:
        beyond = draft.beyond()
        if beyond:
            raise BeyondReachError(beyond)
        grips, missed = draft.reachable_grips(TOSS_TURNS, thorough=True)
    else:
        grips, missed = draft.reachable_grips()
    if missed is not None:
        raise PlanError(missed)
    draft.grips = tuple(grips)
    return draft


def beside(scene: Scene, ahead_m: float, aside_m: float) -> Scene:
    """The scene with the performer standing so far ahead and to the left of there [m]."""
    ahead = np.array([np.cos(scene.heading), np.sin(scene.heading)])
    left = np.array([-ahead[1], ahead[0]])
    x, y = np.asarray(scene.place) + ahead_m * ahead + aside_m * left
    return replace(scene, place=(float(x), float(y)))


def _remedy(search: Search, scene: Scene, human: Human) -> str:
    """What would make it possible."""
    for words, changed, body in _remedies(search.source, scene, human):
        most = FEW_TURNS if body is human else MOST_TURNS
        if search.finds(changed, body, most):
            return f"{words} would do"
    if search.source.tosses:
        return (
            f"none of {search.changes} other heights, sizes, nearer places and bodies that were "
            "tried would do"
        )
    return "no other height, size, nearer place or recorded body that was tried would do"


def _remedies(source: Source, scene: Scene, human: Human) -> Iterator[tuple[str, Scene, Human]]:
    """What may help, in words, and the scene and the body with it."""
    fixed = [name for name, thing in scene.things.items() if thing.tag is TagType.FIXED]
    levels = [(name, by_m) for name in fixed for by_m in HIGHER_M]
    for by_m in NEARER_M if scene.stays else ():
        yield f"standing {by_m:.2f} m further ahead", beside(scene, by_m, 0.0), human
    for name, by_m in levels:
        yield _higher(name, by_m), raised(scene, name, by_m), human
    for by_m in DRAWN_M:
        words = f"what can be moved {by_m:.1f} m nearer to the performer"
        yield words, _drawn_nearer(scene, by_m), human
    for name in mobile(scene):
        smaller = resized_with(scene, name, SMALLER)
        words = " and ".join(repr(one) for one in (name, *taken_with(scene, name)))
        yield f"{words} of {SMALLER:.1f} times the size", smaller, human
    for name, by_m in levels:
        words = f"what can be moved {BOTH_M:.1f} m nearer to the performer"
        nearer = _drawn_nearer(raised(scene, name, by_m), BOTH_M)
        yield f"{_higher(name, by_m)} and {words}", nearer, human
    for thing, (name, by_m) in itertools.product(mobile(scene), levels):
        words = f"{_higher(name, by_m)} and {thing!r} of {SMALLER:.1f} times the size"
        yield words, resized(raised(scene, name, by_m), thing, SMALLER), human
    recorded_m, own_m = (body.measures["stature"] for body in (source.human, human))
    if recorded_m > own_m + TALLER_M:
        yield f"a body as tall as the recorded one, {recorded_m:.2f} m,", scene, source.human


def _higher(name: str, by_m: float) -> str:
    return f"{name!r} {abs(by_m):.1f} m {'higher' if by_m > 0 else 'lower'}"


def _drawn_nearer(scene: Scene, by_m: float) -> Scene:
    """The scene with what can be moved nearer to where the performer stands."""
    for name in mobile(scene):
        thing = scene.thing(name)
        x, y, z = thing.place
        back = (x - by_m * np.cos(scene.heading), y - by_m * np.sin(scene.heading), z)
        scene = moved(scene, name, back, thing.heading)
    return scene


def is_possible(source: Source, scene: Scene, human: Human, most: int = FEW_TURNS) -> bool:
    """Whether a body comes to every goal from just there, with few turns of its grips tried.

    Args:
        source: The recorded performance.
        scene: Where it is performed.
        human: Who performs.
        most: Turns of a grip that are tried.
    """
    try:
        check_stance(scene, human)
        draft = Draft(source, scene, human, own_style(source))
        return draft.reachable_grips(most)[1] is None and not draft.pressed
    except PlanError:
        return False


def _notes(
    source: Source, grips: tuple[Grip, ...], goals: Mapping[str, list[Goal]]
) -> tuple[str, ...]:
    out = list(source.notes)
    for grip in (one for one in grips if not one.beside):
        if grip.turn.drawn_m > 0.0:
            out.append(
                f"the {grip.hold.side} hand takes {grip.hold.thing!r} drawn back by "
                f"{1e3 * grip.turn.drawn_m:.0f} mm along its fingers, so that its forearm stays "
                "outside"
            )
        if abs(grip.out_m) > TOLD_M:
            way = "off" if grip.out_m > 0.0 else "towards"
            out.append(
                f"the {grip.hold.side} hand's grip is moved {1e3 * abs(grip.out_m):.0f} mm {way} "
                f"{grip.hold.thing!r}, so that it just touches"
            )
        if any(grip.turn.eased):
            angle = np.degrees(np.linalg.norm(grip.turn.eased))
            out.append(
                f"the {grip.hold.side} hand's grip on {grip.hold.thing!r} is turned by {angle:.0f} "
                "degrees as the body would take it"
            )
        if grip.turn.size > 0.0:
            out.append(
                f"the {grip.hold.side} hand's grip on {grip.hold.thing!r} is turned by "
                f"{np.degrees(grip.turn.yaw):.0f} degrees about it, "
                f"{np.degrees(grip.turn.pitch):.0f} degrees about the palm's normal and "
                f"{np.degrees(grip.turn.tilt):.0f} degrees across the palm"
            )
        if grip.raised_m > 0.0005:
            higher = f"{grip.raised_m * 1000:.0f} mm higher"
            out.append(
                f"the {grip.hold.side} hand takes {grip.hold.thing!r} {higher}, to stay clear of "
                "what it stands on"
            )
    for name, several in goals.items():
        out += [f"{name!r} at {source.times[g.frame]:.2f} s: {g.reason}" for g in several]
    return tuple(out)
