"""What moves the objects of a segment, in words."""

from collections import defaultdict
from collections.abc import Collection, Mapping

from capar.model.facts import MovedBy
from capar.model.observation import Observation

WORDS: Mapping[str, str] = {
    "carried": "carried by {0}",
    "pushed": "pushed, pulled or struck by {0}",
    "along": "carried along by {0}",
    "through": "moved through {0}",
    "set_going": "going on by itself, or falling",
    "body": "moved with the body ({0})",
    "unknown": "moved by nothing that is recorded",
}
"""How each kind of mover is told, of the mover's name."""


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
    frames: dict[str, dict[str, set[int]]] = defaultdict(lambda: defaultdict(set))
    for fact in seen.facts:
        if isinstance(fact, MovedBy) and fact.object in segment.objects:
            span = range(max(fact.first, segment.first), min(fact.last, segment.last - 1) + 1)
            frames[fact.object][WORDS[fact.how].format(fact.mover)].update(span)
    things = [each for each in segment.objects if each not in staying]
    return tuple(line for thing in things if (line := _line(thing, frames.get(thing, {}))))


def _line(thing: str, movers: Mapping[str, set[int]]) -> str:
    every = set().union(*movers.values())
    if not every:
        return ""
    shares = sorted(((len(found), how) for how, found in movers.items() if found), reverse=True)
    told = "; ".join(f"{how} ({100.0 * count / len(every):.0f} %)" for count, how in shares)
    shared = sum(count for count, _ in shares) > len(every)
    return f"motion of the {thing}: {told}" + "; at times by several at once" * shared
