"""What a summary claims: its clauses, and what was measured of which bodies for each."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product

from capar_rules.explain import arrangements
from capar_rules.explain.claimed_measures import (
    ANY,
    ARRANGED,
    COUNTED,
    END,
    FORMS,
    KEPT,
    LEFT,
    MET,
    OVERLAPPING,
    PREDICATES,
    ROWS,
    THING,
    Bodies,
    Measure,
)
from capar_rules.explain.clock import Clock
from capar_rules.explain.formatting import Argument
from capar_rules.explain.instants import STRETCHES
from capar_rules.explain.reason import Reason
from capar_rules.explain.sentences import Sentences
from capar_rules.explain.told_argument import UNBOUND


@dataclass(frozen=True, slots=True)
class Quantity:
    """What was measured of which bodies between which frames."""

    measure: Measure
    bodies: tuple[str, ...]
    first: int
    last: int
    form: str = ""
    """The format in which its number is told; empty where none is."""

    halts: tuple[int, ...] = ()
    """Frames of what is counted, where that is no part of the quantity itself."""


@dataclass(frozen=True, slots=True)
class Stretches:
    """When facts of a kind about certain bodies hold."""

    predicate: str
    bodies: tuple[str, ...]
    """Those that the fact names, in its order; ``ANY`` for all."""


@dataclass(frozen=True, slots=True)
class Claim:
    """A clause of a summary."""

    text: str
    quantities: tuple[Quantity, ...]
    """What was measured for it."""

    frames: tuple[int, ...] = ()
    """The frames whose times it tells."""

    stretches: tuple[Stretches, ...] = ()
    """What held when, of what it says."""

    of: str = ""
    """The predicate that it tells to hold, in the short clause for it."""

    @property
    def shown(self) -> bool:
        """Whether anything of it can be drawn."""
        return bool(self.quantities or self.stretches)


def claim(
    sentences: Sentences, clock: Clock, told: tuple[str, Sequence[str], str], text: str
) -> Claim:
    """The claim of a clause.

    Args:
        sentences: The templates.
        clock: Times and distances of the segment.
        told: Predicate and arguments of the atom that it tells, and the mood of its template.
        text: The clause.
    """
    predicate, arguments, mood = told
    found: list[Quantity] = []
    frames: list[int] = []
    own = clock.span(clock.own) or (0, 0)
    if predicate == "goes_ahead" and arrangements.little_way(clock, clock.own) is not None:
        thing = clock.objects.get(clock.own, "")
        found.append(Quantity(Measure.ASIDE, (thing,), *own, form="direction"))
    for measure, places in () if found else _measures(predicate, arguments):
        for bodies in _bodies(places, arguments, clock):
            halts = tuple(clock.strokes.get(clock.own, ())) if predicate in COUNTED else ()
            how = "dips" if measure is Measure.INSIDE and "dips" in arguments else ""
            found.append(Quantity(measure, bodies, *own, form=how, halts=halts))
    for text_of, form in sentences.formats(predicate, arguments, mood=mood):
        argument = Argument(text_of, arguments, clock)
        span = argument.measured_between(form)
        for measure in FORMS.get(form, ()):
            measured = own if measure is Measure.SPEED else span
            if measured is not None:
                found.append(Quantity(measure, (argument.body,), *measured, form))
        if form == "turns_back" and span is not None:
            frames += span
        frames += [frame for frame in _told_then(clock, form) if clock.at(frame) in text]
        if form in ("when", "frame"):
            frames.append(int(text_of))
        if form == "tick":
            frames.append(clock.frames[arguments[0]][int(text_of)])
    if predicate == "support":
        frames += _since(clock, own[0])
    if predicate in ("takes", "lets_go"):
        frames += [int(arguments[3]), *_until(clock, own[0])[: predicate == "takes"]]
    stretches = [
        Stretches(kind, bodies)
        for kind, places in _rows(predicate, arguments)
        for bodies in _bodies(places, arguments, clock)
    ]
    held = tuple(dict.fromkeys(stretches))
    of = predicate * mood.startswith("brief")
    return Claim(text, tuple(dict.fromkeys(found)), tuple(frames), held, of)


def _told_then(clock: Clock, form: str) -> tuple[int, ...]:
    """The frames that a format of the explained segment may tell, beside its own borders."""
    if form in ("laid", "not_laid"):
        return arrangements.laid_frames(clock, clock.own)
    kept = arrangements.keeper(clock, clock.own) if form == "keeper" else None
    return (kept[0], kept[2]) if kept else ()


def _since(clock: Clock, frame: int) -> list[int]:
    """Since when the end-effector of the explained segment touches its object."""
    thing, hand = clock.objects.get(clock.own, ""), arrangements.hand_of(clock.own)
    met = clock.measured.contact(hand, thing, frame, 1)
    return [met[0]] if met else []


def _until(clock: Clock, frame: int) -> list[int]:
    """Until when the end-effector touches its object, of the contact at a frame."""
    thing, hand = clock.objects.get(clock.own, ""), arrangements.hand_of(clock.own)
    met = clock.measured.contact(hand, thing, frame, 1)
    return [met[1]] if met else []


def joined_claims(text: str, claims: Sequence[Claim]) -> Claim:
    """The claim of a clause that says as much as several."""
    quantities = dict.fromkeys(quantity for claim in claims for quantity in claim.quantities)
    stretches = dict.fromkeys(held for claim in claims for held in claim.stretches)
    frames = tuple(frame for each in claims for frame in each.frames)
    return Claim(text, tuple(quantities), frames, tuple(stretches))


def resting_on(found: Claim, reason: Reason) -> Claim:
    """The claim of a clause that tells a node, with what was measured below, if it had nothing."""
    if found.shown:
        return found
    below: dict[Stretches, None] = {}
    for node in reason.walk():
        predicate, _, rest = node.atom.removesuffix(")").partition("(")
        if not node.rule and predicate in STRETCHES:
            bodies = tuple(rest.split(",")[: STRETCHES[predicate]])
            below[Stretches(predicate, bodies)] = None
    return replace(found, stretches=tuple(below))


def _measures(predicate: str, arguments: Sequence[str]) -> tuple[tuple[Measure, Bodies], ...]:
    if predicate == "lies_at":
        return tuple((measure, (3, 4)) for measure in ARRANGED.get(arguments[2], ()))
    if predicate == "overlaps":
        return tuple((measure, (2, 3)) for measure in ARRANGED.get(arguments[1], ()))
    if predicate == "on" and UNBOUND in arguments[3]:
        return ((Measure.BORNE, (2, ANY)),)
    return PREDICATES.get(predicate, ())


def _rows(predicate: str, arguments: Sequence[str]) -> tuple[tuple[str, Bodies], ...]:
    if predicate == "overlaps" and arguments[1] in OVERLAPPING:
        return ((arguments[1], (2,)),)
    if predicate == "lies_at" and arguments[2] not in ARRANGED:
        return ()
    return ROWS.get(predicate, ())


def _bodies(places: Bodies, arguments: Sequence[str], clock: Clock) -> list[tuple[str, ...]]:
    """The bodies at some places, in each combination; none if one is not known."""
    ways = [_at(place, arguments, clock) for place in places]
    return [bodies for bodies in product(*ways) if all(bodies)]


def _at(place: int | str, arguments: Sequence[str], clock: Clock) -> tuple[str, ...]:
    if isinstance(place, int):
        body = arguments[place]
        return () if UNBOUND in body else (body,)
    segment = arguments[0]
    of_segment: Mapping[str, Callable[[], tuple[str, ...]]] = {
        THING: lambda: (clock.objects.get(segment, ""),),
        END: lambda: (arrangements.hand_of(segment),),
        KEPT: lambda: arrangements.kept(clock, segment),
        LEFT: lambda: arrangements.left(clock, segment),
        MET: lambda: arrangements.met_at(clock, segment, arguments[1]),
        ANY: lambda: (ANY,),
    }
    return of_segment[place]()
