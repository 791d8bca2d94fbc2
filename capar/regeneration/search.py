"""The order of search from a capture to a verified motion of another body.

Each step is taken only if the one before does not do.

======  ================================================  ======================================
step    what is tried                                     the case that needs it
======  ================================================  ======================================
goals   one for each object and event                     (no alternative)
grips   the recorded one, turned: smallest turns first    a table or crate of another height
        drawn back along the fingers                      a forearm inside a large object
        with hands led more firmly                        a wrist at its limit, bent as posture asks
place   the given one, then twelve around it              a wrist at its limit
paths   the recorded one, lifted, drawn back, kept off    a table's edge, the rim of a mug
motion  as planned                                        nearly all
        wider margins of free hands                       a mug cut in passing
        hands led more firmly besides                     a hand that arrives late
        drawn to the key postures of the grips            an elbow that bent the other way
        with grips that are missed by less                a forearm that meets a box as it leaves
refuse  remedies: nearer, higher, lower, smaller, taller  what is out of reach
======  ================================================  ======================================

The motion that fails fewest gates (``quality``) is kept, if only ``MOST_FRAMES`` were tried; what
is not in reach of ``MOST_POSTURES`` is refused.
``paths`` tries the paths.
"""

import itertools
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from capar.body.human import Human
from capar.model.capture import TagType
from capar.regeneration.collisions import NEAR_M, Surroundings, things_apart
from capar.regeneration.grips import Grip, Turn, drawn_turns, turns
from capar.regeneration.holds import led_holds
from capar.regeneration.motion import Motion, guide_of, perform_plan
from capar.regeneration.paths import Care
from capar.regeneration.planning import CUT_M, Draft, Miss, led
from capar.regeneration.quality import Quality, quality
from capar.regeneration.scenes import (
    PlanError,
    Scene,
    mobile,
    moved,
    raised,
    resized_with,
    taken_with,
)
from capar.regeneration.solving import Solver
from capar.regeneration.sources import Hold, Source
from capar.regeneration.styles import Style, own_style

WIDER = Care(margin_m=0.03, off_m=0.015)
CARES = (Care(), WIDER, replace(WIDER, firm_s=1.0, weight=2.0))
"""How free hands keep from objects, and how firmly hands are led; the next where that fails."""

BY_CARE = {"penetration", "free hand clear", "event position", "event rotation", "on the way"}
"""The gates that more care may mend: a hand that is led firmly for longer arrives in time."""

EASY = 0.5
"""As large a share of what is allowed a grip may be missed by where the motion of others fails."""

NEARLY = 3.0  # A grip that is missed by more no hand that is led more firmly reaches [1].

MOST_TURNS, FEW_TURNS = 24, 6
"""Turns of a grip that are tried; where another place or a remedy is sought [1]."""

MOST_POSTURES, ATTEMPT = 300, 5
"""Key postures that are tried until something is refused, and as how many of them the paths of one
attempt count: either takes 70 ms, so that they take less than 30 s [1]."""

MOST_FRAMES, LOOKS = 8000, 10
"""Frames of all motions that are tried, so that a search ends; more only of a first motion [1].

A frame takes 3 ms, so that all take less than 30 s; looking ten times at which part of a hollow
object, such as a chair, is near a limb takes as long as a frame and counts as one [1]."""

APART_M = 0.02
"""Objects that a hand takes together are no more than this farther apart than they were [m]."""

STEPS_M = (
    (0.05, 0.0), (-0.05, 0.0), (0.1, 0.0), (-0.1, 0.0), (0.0, -0.1), (0.0, 0.1),
    (0.1, -0.1), (0.1, 0.1), (-0.1, -0.1), (-0.1, 0.1), (0.2, 0.0), (-0.2, 0.0),
)  # fmt: skip
"""Places that are tried, from the given one ahead and to the left [m]."""

NEARER_M, HIGHER_M, DRAWN_M = (
    (0.05, 0.1, 0.15, 0.2, 0.3), (0.1, -0.1, 0.2, -0.2, 0.4, -0.4), (0.1, 0.2, 0.3)
)  # fmt: skip
"""Remedies that are tried where something is out of reach [m]: standing, fixed objects, others."""

SMALLER, MOST_CHANGES = 0.7, 24
"""Likewise the size of what can be moved, and how many remedies in all [1]."""

TALLER_M = 0.02  # A recorded body that is so much taller is tried, too [m].


def regenerate(
    source: Source, human: Human, scene: Scene | None = None, style: Style | None = None
) -> tuple[Motion, Quality]:
    """Let a body do in a scene what was recorded; verified at every frame.

    The recorded scene and style, unless stated.

    Raises:
        PlanError: It is out of reach or impossible; the message says what would help.
    """
    return best_motion(reachable(source, scene or source.scene, human, style))


def best_motion(draft: Draft) -> tuple[Motion, Quality]:
    """The motion of a draft with grips that fails fewest gates."""
    tried: list[tuple[Motion, Quality]] = []
    frames, spent = len(draft.source.times), 0.0
    ways = ((False, False), (True, False), (False, True)) if draft.grips else ((False, False),)
    for guided, easy in ways:
        if tried and (spent + frames > MOST_FRAMES or min(tried, key=_failures)[1].passed):
            break
        if easy and not eased(draft):
            break
        guide = guide_of(draft) if guided else None
        for care in CARES:
            motion = perform_plan(led(draft, care), guide)
            tried.append((motion, quality(motion)))
            spent += frames + motion.looks / LOOKS
            if spent + frames > MOST_FRAMES or not BY_CARE & set(tried[-1][1].failed):
                break
    return min(tried, key=_failures)


def _failures(made: tuple[Motion, Quality]) -> tuple[int, float]:
    """How many gates fail, and by how much of their limits in all."""
    failed = [gate for gate in made[1].gates if not gate.passed]
    beyond = (abs(gate.value - gate.limit) / max(abs(gate.limit), 1e-9) for gate in failed)
    return len(failed), float(sum(beyond))


def reachable(source: Source, scene: Scene, human: Human, style: Style | None = None) -> Draft:
    """Goals, and grips that reach them, from where it stands or, unless it stays, from nearby.

    Raises:
        PlanError: Something is out of reach or cannot be put down; the message says what would
            help.
    """
    style = style or own_style(source)
    _check_co_held(source, scene, human)
    why, draft = _attempt(source, scene, human, style)
    if draft and not why:
        return draft
    tried = _postures(draft)
    for ahead_m, aside_m in () if scene.stays else STEPS_M:
        if tried > MOST_POSTURES:
            break
        nearby = beside(scene, ahead_m, aside_m)
        missed, draft = _attempt(source, nearby, human, style, FEW_TURNS)
        if draft and not missed:
            place = f"{ahead_m:+.2f} m ahead and {aside_m:+.2f} m to its left"
            draft.notes.append(f"stands {place} of the given place, since there {why}")
            return draft
        tried += _postures(draft)
    for words, changed, body in itertools.islice(_remedies(source, scene, human), MOST_CHANGES):
        if tried > MOST_POSTURES:
            break
        missed, draft = _attempt(source, changed, body, style, FEW_TURNS)
        if not missed:
            raise PlanError(f"{why}; {words} would do")
        tried += _postures(draft)
    raise PlanError(
        f"{why}; no other height, size, nearer place or recorded body that was tried would do"
    )


def why_unreachable(source: Source, scene: Scene, human: Human, style: Style) -> str:
    """Why a body does not come to every goal from just there; empty where it does."""
    return _attempt(source, scene, human, style)[0]


def is_possible(source: Source, scene: Scene, human: Human) -> bool:
    """Whether a body comes to every goal from just there, with few turns of its grips tried."""
    return not _attempt(source, scene, human, own_style(source), FEW_TURNS)[0]


def _attempt(
    source: Source, scene: Scene, human: Human, style: Style, most: int = MOST_TURNS
) -> tuple[str, Draft | None]:
    """Why a body does not come to every goal from just there, empty where it does; and the draft.

    No draft where it has no paths. What is likely to fail is first asked for what lies beyond it.
    """
    try:
        check_stance(scene, human)
        draft = Draft(source, scene, human, style)
        missed = most == MOST_TURNS and choose_grips(draft, 1)
        if missed == "":
            return "", draft
        return draft.beyond() or choose_grips(draft, most), draft
    except PlanError as error:
        return str(error), None


def _postures(draft: Draft | None) -> int:
    """How many key postures an attempt took, its paths counted as some."""
    return ATTEMPT + (draft.postures if draft else 0)


def eased(draft: Draft) -> bool:
    """Choose grips that are missed by less; whether there are others."""
    before = [grip.turn for grip in draft.grips]
    missed = choose_grips(draft, ratio=EASY)
    return not missed and before != [grip.turn for grip in draft.grips]


def choose_grips(draft: Draft, most: int = MOST_TURNS, ratio: float = 1.0) -> str:
    """Choose a grip for every hold; returns what is missed, empty if nothing.

    The first of so many turns of the recorded grip that is missed by no more than a share of what
    is allowed, else the one that is missed least. If all of them are tried and none reaches, then,
    where the forearm is inside the object, of those drawn back along the fingers, or, where one is
    nearly reached, of all with hands led as firmly as the last of ``CARES`` leads them.
    """
    chosen: list[Grip] = []
    for group in _groups(led_holds(draft.source.holds, draft.source.co_held)):
        options = turns(draft.scene.thing(group[0].thing))[:most]
        miss, grips = _best_grips(draft, chosen, group, options, ratio)
        if miss.ratio > 1.0 and most == MOST_TURNS and (miss.cuts or miss.ratio < NEARLY):
            draft.firm = draft.firm if miss.cuts else CARES[-1].weight
            more = drawn_turns() if miss.cuts else options
            others = _best_grips(draft, chosen, group, more, ratio)
            miss, grips = min((miss, grips), others, key=lambda tried: tried[0].ratio)
        if miss.ratio > 1.0:
            return miss.sentence
        chosen += grips
    draft.grips = tuple(chosen)
    return ""


def _best_grips(
    draft: Draft, chosen: list[Grip], group: list[Hold], options: list[Turn], ratio: float = 1.0
) -> tuple[Miss, list[Grip]]:
    """The first of some turns that is missed by so little, or else the one that misses least."""
    tried: list[tuple[Miss, list[Grip]]] = []
    for turn in options:
        grips = draft.gripping.grips(group, turn)
        enough = max(min((miss.ratio for miss, _ in tried), default=np.inf), ratio)
        tried.append((draft.missed(chosen + grips, group, enough), grips))
        if tried[-1][0].ratio <= ratio or draft.postures > MOST_POSTURES:
            break
    return min(tried, key=lambda each: each[0].ratio)


def _groups(holds: tuple[Hold, ...]) -> list[list[Hold]]:
    """Holds of one object that overlap, in order of time."""
    out: list[list[Hold]] = []
    for hold in holds:
        for group in out:
            same = group[0].thing == hold.thing
            if same and any(o.first <= hold.last and hold.first <= o.last for o in group):
                group.append(hold)
                break
        else:
            out.append([hold])
    return out


def check_stance(scene: Scene, human: Human) -> None:
    """Whoever stands at ease stands in nothing.

    Raises:
        PlanError: A part of the body is inside an object.
    """
    around = Surroundings(human, scene)
    solver = Solver(human, (*scene.place, scene.floor_m), scene.heading)
    around.pose(solver.rest, {name: thing.pose for name, thing in scene.things.items()})
    for pair in around.near():
        if pair.distance_m < 0.0:
            raise PlanError(
                f"standing at ({scene.place[0]:.2f}, {scene.place[1]:.2f}) m the performer's "
                f"{pair.part} is {-pair.distance_m * 1000:.0f} mm inside {pair.thing!r}; stand "
                "further back, or put it elsewhere"
            )


def _check_co_held(source: Source, scene: Scene, human: Human) -> None:
    """What a hand takes together stands beside each other, about as near as it did."""
    for pair in source.co_held:
        names = pair.hold.thing, pair.lead.thing
        before, now = (things_apart(where, names, human) for where in (source.scene, scene))
        new, old = (where.thing(names[1]).size.max() for where in (scene, source.scene))
        if -CUT_M <= now <= before * max(new / old, 1.0) + APART_M:
            continue
        far = f"{1e3 * NEAR_M:.0f} mm or more from" if now >= NEAR_M else f"{1e3 * now:.0f} mm from"
        where = f"{-1e3 * now:.0f} mm inside" if now < 0.0 else far
        raise PlanError(
            f"{names[0]!r} stands {where} {names[1]!r}, with which the {pair.hold.side} hand takes "
            f"it; it stood {1e3 * before:.0f} mm from it: put it so"
        )


def beside(scene: Scene, ahead_m: float, aside_m: float) -> Scene:
    """The scene with the performer standing so far ahead and to the left of there [m]."""
    ahead = np.array([np.cos(scene.heading), np.sin(scene.heading)])
    left = np.array([-ahead[1], ahead[0]])
    x, y = np.asarray(scene.place) + ahead_m * ahead + aside_m * left
    return replace(scene, place=(float(x), float(y)))


def _remedies(source: Source, scene: Scene, human: Human) -> Iterator[tuple[str, Scene, Human]]:
    """What may help, in words, and the scene and the body with it."""
    levels = {
        f"{name!r} {abs(by_m):.1f} m {'higher' if by_m > 0 else 'lower'}": raised(scene, name, by_m)
        for name, thing in scene.things.items()
        if thing.tag is TagType.FIXED
        for by_m in HIGHER_M
    }
    for by_m in NEARER_M if scene.stays else ():
        yield f"standing {by_m:.2f} m further ahead", beside(scene, by_m, 0.0), human
    for words, level in levels.items():
        yield words, level, human
    nearer = "what can be moved {:.1f} m nearer to the performer"
    for by_m in DRAWN_M:
        yield nearer.format(by_m), _drawn_nearer(scene, by_m), human
    for name in mobile(scene):
        words = " and ".join(repr(one) for one in (name, *taken_with(scene, name)))
        smaller = resized_with(scene, name, SMALLER)
        yield f"{words} of {SMALLER:.1f} times the size", smaller, human
    recorded_m, own_m = (body.measures["stature"] for body in (source.human, human))
    if recorded_m > own_m + TALLER_M:
        yield f"a body as tall as the recorded one, {recorded_m:.2f} m,", scene, source.human
    for words, level in levels.items():
        both = f"{words} and {nearer.format(DRAWN_M[1])}"
        yield both, _drawn_nearer(level, DRAWN_M[1]), human


def _drawn_nearer(scene: Scene, by_m: float) -> Scene:
    """The scene with what can be moved nearer to where the performer stands."""
    for name in mobile(scene):
        thing = scene.thing(name)
        x, y, z = thing.place
        back = (x - by_m * np.cos(scene.heading), y - by_m * np.sin(scene.heading), z)
        scene = moved(scene, name, back, thing.heading)
    return scene
