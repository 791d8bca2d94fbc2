"""What moves the objects of a segment, a line for each object."""

from collections import defaultdict
from collections.abc import Collection, Mapping, Sequence

from capar.model.body_names import is_plural, limb_names
from capar.model.facts import MovedBy
from capar.model.observation import Observation
from capar.views.picture import spoken

WORDS: Mapping[str, str] = {
    "carried": "moved by the {0}",
    "pushed": "moved by the {0}",
    "along": "carried along by the {0}",
    "through": "moved through the {0}",
    "set_going": "moving on with no contact measured",
    "body": "moved with the body (the {0})",
    "unknown": "moved by nothing that is recorded",
}
"""What is said of each kind of mover. Whether a hand held or pushed is left to the segment's name,
as noise decides between the two."""

ALL_BUT = 0.95
"""From this share of a motion on, a mover is said to move the object throughout [1]."""

MOST_NAMED = 6
"""The most movers of one object that are named, those with the greatest shares."""


def mover_lines(
    seen: Observation, ee: str, index: int, *, staying: Collection[str] = ()
) -> tuple[str, ...]:
    """For each object that moves in a segment, what moves it and for which share of its motion.

    Args:
        seen: What was observed.
        ee: The end-effector of the segment.
        index: Its number in the link.
        staying: Objects whose motion does not count there; they are left out.
    """
    (segment,) = (each for each in seen.segments if (each.ee, each.index) == (ee, index))
    names = limb_names(seen)
    hands = {link.ee for link in seen.links if link.kind == "hand"}
    limbs = {link.ee for link in seen.links} - hands
    lines = []
    for thing in segment.objects:
        frames: dict[int, set[tuple[str, str]]] = defaultdict(set)
        for fact in seen.facts:
            if isinstance(fact, MovedBy) and fact.object == thing and thing not in staying:
                for frame in range(
                    max(fact.first, segment.first), min(fact.last + 1, segment.last)
                ):
                    frames[frame].add((fact.how, fact.mover))
        counts: dict[str, int] = defaultdict(int)
        for movers in frames.values():
            by_hand = bool({who for _, who in movers} & hands)
            # Arms and trunk go along with the hand that moves the object.
            moving = {(how, who) for how, who in movers if not (by_hand and who in limbs)}
            for words in {WORDS[how].format(names.get(who, spoken(who))) for how, who in moving}:
                counts[words] += 1
        if counts:
            name = names.get(thing, spoken(thing))
            was = "were" if is_plural(thing) else "was"
            lines.append(f"The {name} {was} {_shares(counts, len(frames))}.")
    return tuple(lines)


def _shares(counts: Mapping[str, int], total: int) -> str:
    """Each mover, those with the greatest share first; of a single one all along without it."""
    ordered = sorted(counts.items(), key=lambda each: (-each[1], each[0]))
    (first, count), *more = ordered
    if not more and count >= ALL_BUT * total:
        return first
    told = [f"{words} ({100 * count / total:.0f} %)" for words, count in ordered[:MOST_NAMED]]
    left = len(ordered) - MOST_NAMED
    return joined([*told, f"by {left} others"] if left > 0 else told)


def joined(parts: Sequence[str]) -> str:
    """Parts as a list in words."""
    *most, last = parts
    return f"{', '.join(most)}{' and ' * bool(most)}{last}"
