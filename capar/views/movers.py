"""What moves the objects of a segment, in words."""

from collections import Counter, defaultdict
from collections.abc import Collection, Mapping, Sequence

from capar.model.body_names import body_names
from capar.model.facts import MovedBy
from capar.model.observation import Observation
from capar.views.rows import spoken

WORDS: Mapping[str, str] = {
    "carried": "carried by {0}",
    "pushed": "pushed, pulled or struck by {0}",
    "along": "carried along by {0}",
    "through": "moved through {0}",
    "set_going": "going on with no contact measured",
    "body": "moved with the body ({0})",
    "unknown": "moved by nothing that is recorded",
}
"""How each kind of mover is told, of the mover's name."""


ALL_BUT = 95.0
"""A mover of this share of a motion is told alone [%]."""


def mover_lines(
    seen: Observation, ee: str, index: int, *, staying: Collection[str] = ()
) -> tuple[str, ...]:
    """For each object that moves in a segment, what moves it and in how much of its motion.

    Args:
        seen: What was observed.
        ee: The end-effector of the segment.
        index: Its number in the link.
        staying: Objects whose motion does not count there; nothing is told of what moves them.
    """
    segment = next(
        each
        for link in seen.links
        for each in link.segments
        if (each.ee, each.index) == (ee, index)
    )
    frames: dict[str, dict[int, set[tuple[str, str]]]] = defaultdict(lambda: defaultdict(set))
    for fact in seen.facts:
        if isinstance(fact, MovedBy) and fact.object in segment.objects:
            for frame in range(max(fact.first, segment.first), min(fact.last + 1, segment.last)):
                frames[fact.object][frame].add((fact.how, fact.mover))
    names = body_names(seen)
    things = [each for each in segment.objects if each not in staying]
    return tuple(_line(thing, frames[thing], names) for thing in things if frames.get(thing))


def _line(
    thing: str, movers: Mapping[int, Collection[tuple[str, str]]], names: Mapping[str, str]
) -> str:
    """What moves a thing, with shares of the time it moves that sum to 100 %."""
    shares = Counter(_together(found, names) for found in movers.values()).most_common()
    told = [(how, 100.0 * count / len(movers)) for how, count in shares]
    thing = names.get(thing, spoken(thing))
    if told[0][1] >= ALL_BUT:
        return f"The {thing} was {told[0][0]}."
    (first, share), *others = told
    parts = [f"{first} for {share:.0f} % of the time it moved"]
    parts += [f"{how} for {share:.0f} %" for how, share in others]
    return f"The {thing} was {joined(parts)}."


def _together(movers: Collection[tuple[str, str]], names: Mapping[str, str]) -> str:
    """What several movers do at once, those that do the same together."""
    found: dict[str, list[str]] = defaultdict(list)
    for how, mover in sorted(movers):
        found[how].append(names.get(mover, spoken(mover)))
    return joined([WORDS[how].format(joined(who, before="the ")) for how, who in found.items()])


def joined(parts: Sequence[str], *, before: str = "") -> str:
    """Parts as a list in words, each with a word before it."""
    *most, last = (f"{before}{each}" for each in parts)
    return f"{', '.join(most)}{' and ' * bool(most)}{last}"
