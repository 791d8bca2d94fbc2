"""What held when, of what an explanation says without a number, as bars over time."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields, replace

from capar.model.facts import Fact, Link, Resting, Solid, Tag
from capar.pipelines.measured.recording import Recording
from capar.views.lettering import Span
from capar.views.movers import MoverStretches
from capar.views.panels import Held, Row
from capar_rules.explain.claimed_measures import ANY
from capar_rules.explain.claims import Claim, Stretches
from capar_rules.explain.instants import STRETCHES

LABELS: Mapping[str, str] = {
    "touching": "{0} and {1}: count as in contact",
    "resting": "{0}: counts as at rest",
    "moving": "{0}: counts as moving",
    "looking_at": "{0}: looks at the {1}",
    "flies": "{0}: flies freely",
    "rolls": "{0}: turns as it goes, without slipping",
    "lengthwise": "{0}: goes along its own length",
    "swings": "{0}: goes to and fro",
    "leans": "{0}: counts as a far lean",
    "lies": "{0}: {1} the {2}",
    "bears": "{0}: bears of the weight of the body: {1}",
    "moves_with": "{0}: moves with the {1}",
    "doubted": "{0}: a flicker, which is not taken as it was measured",
    "lost": "{0}: not tracked",
}
"""By the predicate of a fact: what a row of its stretches is called."""

NOTHING = "{0}: in contact with no recorded or assumed object in the time shown"
NOTHING_ELSE = "{0}: in contact with nothing else in the time shown"
NO_OBJECT = "{0}: in contact with no object (the recording has none)"
"""The rows of a body that touches nothing, or nothing else, and where there is nothing to touch."""

FEWEST = 4
"""Where more bodies would have a row each, they share one [1]."""


def claimed_rows(known: Recording, claims: Sequence[Claim]) -> Iterator[Row]:
    """A row for what held when, of each claim, in their order."""
    wanted = dict.fromkeys(stretches for claim in claims for stretches in claim.stretches)
    done: set[str] = set()
    for stretches in wanted:
        for row in _rows(known, stretches):
            if row.label not in done:
                done.add(row.label)
                yield row


def mover_rows(known: Recording, movers: Sequence[MoverStretches]) -> Iterator[Row]:
    """A row for each way in which something moves a thing in the segment."""
    for mover in movers:
        bars = tuple(Span(known.at(first), known.at(last + 1), "") for first, last in mover.spans)
        yield Row(f"{mover.thing}: {mover.words}, for {mover.percent} % of its motion", bars)


def _rows(known: Recording, wanted: Stretches) -> Iterator[Row]:
    if wanted.predicate == "lost":
        called = tuple(known.called(body) for body in wanted.bodies)
        row = _row(known, "lost", wanted.bodies, known.lost(*wanted.bodies))
        yield replace(row, held=("lost", *called))
        return
    if wanted.predicate == "thing":
        yield _thing(known, *wanted.bodies)
        return
    if wanted.predicate == "link":
        yield from _kinds(known, *wanted.bodies)
        return
    found: dict[tuple[str, ...], list[Span]] = {}
    count = STRETCHES[wanted.predicate]
    for fact in known.seen.observation.facts:
        if type(fact).predicate == wanted.predicate and _matches(fact, wanted.bodies):
            about = _about(fact, count)
            first, last = (getattr(fact, end) for end in ("first", "last"))
            if isinstance(fact, Resting) and last - first < known.least_rest:
                continue
            if first <= known.span[1] and last >= known.span[0]:
                begin, end = max(first, known.span[0]), min(last, known.span[1])
                found.setdefault(about, []).append(Span(known.at(begin), known.at(end), ""))
    several = len(found) > FEWEST and ANY in wanted.bodies
    if several:
        found = {wanted.bodies: [span for spans in found.values() for span in spans]}
    for about, bars in found.items():
        yield _row(known, wanted.predicate, about, bars)
    if found and wanted.predicate == "touching" and ANY in wanted.bodies and not several:
        named = [known.called(body) for body in wanted.bodies if body != ANY]
        yield Row(NOTHING_ELSE.format(*named), ())
    if not found:
        named = [known.called(body) for body in wanted.bodies if body != ANY]
        if ANY in wanted.bodies:
            none = NOTHING if known.seen.observation.objects else NO_OBJECT
            yield Row(none.format(*named), ())
            return
        label = LABELS.get(wanted.predicate, " ".join(["{}"] * len(named))).format(*named)
        yield Row(f"{label} (not in the time shown)", (), _held(wanted.predicate, wanted.bodies))


def _held(predicate: str, about: Sequence[str]) -> Held:
    return (predicate, *sorted(about))


def _matches(fact: Fact, bodies: Sequence[str]) -> bool:
    return all(
        body in (ANY, value) for body, value in zip(bodies, _about(fact, len(bodies)), strict=True)
    )


def _about(fact: Fact, count: int) -> tuple[str, ...]:
    return tuple(str(getattr(fact, field.name)) for field in fields(fact)[:count])


def _row(known: Recording, predicate: str, about: Sequence[str], bars: Sequence[Span]) -> Row:
    called = [
        "any recorded or assumed object" if body == ANY else known.called(body) for body in about
    ]
    label = LABELS.get(predicate, "{0}: " + predicate.replace("_", " "))
    return Row(label.format(*called), tuple(bars), _held(predicate, about))


def _thing(known: Recording, name: str) -> Row:
    """What is known of a thing, all the time."""
    facts = known.seen.observation.facts
    tags = [fact for fact in facts if isinstance(fact, Tag)]
    kinds = [fact.type for fact in tags if fact.object == name]
    shapeless = name in known.seen.explainer.measured.shapeless
    solid = any(isinstance(fact, Solid) and fact.object == name for fact in facts)
    shape = "its shape is not known" if shapeless else "no hollow" if solid else "has a hollow"
    whole = Span(known.at(known.span[0]), known.at(known.span[1]), "")
    return Row(f"{known.called(name)}: {', '.join(kinds)}; {shape}", (whole,))


def _kinds(known: Recording, name: str) -> Iterator[Row]:
    """What an end-effector counts as, which it does all the time."""
    whole = Span(known.at(known.span[0]), known.at(known.span[1]), "")
    for fact in known.seen.observation.facts:
        if isinstance(fact, Link) and fact.ee == name:
            yield Row(
                f"{known.called(name)}: counts as the {fact.kind.replace('_', ' ')}", (whole,)
            )
