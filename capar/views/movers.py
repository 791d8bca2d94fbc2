"""What moves the objects of a segment, in words."""

from collections import Counter, defaultdict
from collections.abc import Collection, Iterator, Mapping, Sequence

from capar.model.body_names import is_plural, limb_names
from capar.model.facts import MovedBy, Touching
from capar.model.observation import Observation
from capar.views.picture import spoken

WORDS: Mapping[str, str] = {
    "carried": "moved by {0}",
    "pushed": "moved by {0}",
    "along": "carried along by {0}",
    "through": "moved through {0}",
    "set_going": "going on with no contact measured",
    "body": "moved with the body ({0})",
    "unknown": "moved by nothing that is recorded",
}
"""How each kind of mover is told, of the mover's name.

What a hand does is told in one way, whether the thing was steady in its frame or slipped: noise
decides between the two, and the segment's name says how it was moved.
"""


BY_HAND = frozenset({"carried", "pushed"})
"""Kinds of motion in which an end-effector moves the thing."""

WITHOUT_MOVER = frozenset({"set_going", "unknown"})
"""Kinds of motion in which nothing moves the thing."""

HAND = "hand"
"""The kind of end-effector that takes things."""

ALL_BUT = 95.0
"""What has this share of a motion is told of all of it [%]."""

OF_TIME = " of the time it moved"
ALL_THE_TIME = " all the time it moved"

MOST_TOLD = 6
"""The most movers of one thing that are named, those with the greatest shares [1]."""


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
    names = limb_names(seen)
    return tuple(
        _line(names.get(thing, spoken(thing)), frames, _apart(seen, thing, frames))
        for thing, frames in _moved(seen, ee, index, staying)
    )


def _apart(
    seen: Observation, thing: str, frames: Mapping[int, Collection[tuple[str, str]]]
) -> Mapping[str, list[int]]:
    """The frames in which each end-effector moves a thing without contact that counts, if many."""
    names = limb_names(seen)
    met: dict[str, set[int]] = {names.get(link.ee, link.ee): set() for link in seen.links}
    for fact in seen.facts:
        if isinstance(fact, Touching) and fact.other == thing:
            met.get(names.get(fact.body, fact.body), set()).update(range(fact.first, fact.last + 1))
    alone: dict[str, list[int]] = defaultdict(list)
    for frame, movers in sorted(frames.items()):
        for who in sorted({who for how, who in movers if how in BY_HAND}):
            if who in met and frame not in met[who]:
                alone[who].append(frame)
    least = (1.0 - ALL_BUT / 100.0) * len(frames)
    return {who: held for who, held in sorted(alone.items()) if len(held) > least}


def _words(how: str, who: str, *, moving: Collection[str]) -> str:
    """What a mover does at a time, to stand after the thing; some merely touch it."""
    moves = who in moving or how in WITHOUT_MOVER
    return (WORDS[how] if moves else "in contact with {0}").format(f"the {spoken(who)}")


def _moved(
    seen: Observation, ee: str, index: int, staying: Collection[str]
) -> Iterator[tuple[str, Mapping[int, Collection[tuple[str, str]]]]]:
    """Each object that moves in a segment, and how what moves it in each of its frames."""
    segment = next(
        each
        for link in seen.links
        for each in link.segments
        if (each.ee, each.index) == (ee, index)
    )
    names = limb_names(seen)
    limbs = {names.get(link.ee, link.ee) for link in seen.links}
    hands = {names.get(link.ee, link.ee) for link in seen.links if link.kind == HAND}
    frames: dict[str, dict[int, set[tuple[str, str]]]] = defaultdict(lambda: defaultdict(set))
    for fact in seen.facts:
        if isinstance(fact, MovedBy) and fact.object in segment.objects:
            for frame in range(max(fact.first, segment.first), min(fact.last + 1, segment.last)):
                frames[fact.object][frame].add((fact.how, names.get(fact.mover, fact.mover)))
    for thing in segment.objects:
        if thing not in staying and frames.get(thing):
            yield thing, _by_hands(frames[thing], hands, limbs)


def _by_hands(
    frames: Mapping[int, Collection[tuple[str, str]]], hands: set[str], limbs: set[str]
) -> Mapping[int, Collection[tuple[str, str]]]:
    """Movers by frame, without arms and trunk where hands move it: they go along with these."""
    found = {}
    for frame, movers in frames.items():
        by_hand = {who for _, who in movers} & hands
        others = limbs - hands if by_hand else set()
        found[frame] = {(how, who) for how, who in movers if who not in others}
    return found


def _spans(frames: Sequence[int]) -> Iterator[tuple[int, int]]:
    """First and last of the frames that follow each other."""
    first = last = frames[0]
    for frame in frames[1:]:
        if frame != last + 1:
            yield first, last
            first = frame
        last = frame
    yield first, last


def _line(
    thing: str,
    frames: Mapping[int, Collection[tuple[str, str]]],
    apart: Mapping[str, Sequence[int]],
) -> str:
    """What moves a thing: one plain statement, or each mover with its share of the time."""
    was, it = ("were", "them") if is_plural(thing) else ("was", "it")
    touching = _touching(frames.values())
    movers = {
        frame: [(how, mover) for how, mover in found if mover not in touching]
        for frame, found in frames.items()
    }
    beside = _beside(frames, touching, it) + _without_contact(apart, frames, it)
    ways = Counter(_together(found) for found in movers.values()).most_common(1)
    (together, count) = ways[0]
    if 100.0 * count >= ALL_BUT * len(movers):
        return f"The {thing} {was} {together}{beside}."
    shares = Counter(mover for found in movers.values() for mover in _movers(found))
    if not shares:
        return f"The {thing} {was} {' or '.join(_without_mover(movers.values()))}."
    most = sorted(shares.items(), key=lambda share: (-share[1], share[0]))[:MOST_TOLD]
    alike: dict[str, list[str]] = {}
    for mover, count in most:
        alike.setdefault(_how_long(count, len(movers)), []).append(f"the {spoken(mover)}")
    told = [f"by {joined(who)}{how_long}" for how_long, who in alike.items()]
    several = len(told) > 1 and told[0].endswith(ALL_THE_TIME)
    told = (
        [told[0], *(share.replace(OF_TIME, " of it") for share in told[1:])]
        if several
        else [*(share.removesuffix(OF_TIME) for share in told[:-1]), *told[-1:]]
    )
    others = len(shares) - len(most)
    told += [f"by {others} other{'s' * (others > 1)}"] if others else []
    alike_at = sum(len(_movers(found) - touching) > 1 for found in frames.values())
    word = "both" if len(shares) == 2 else "several"
    percent = round(100.0 * alike_at / len(frames))
    both = f" ({percent} % of it {word} at once)" * bool(percent)
    both = both if len(shares) > 1 and ALL_THE_TIME not in " ".join(told) else ""
    remainder = _remainder(movers.values(), it="they were" if is_plural(thing) else "it was")
    return f"The {thing} {was} moved {joined(told)}{both}{remainder}{beside}."


def _beside(
    frames: Mapping[int, Collection[tuple[str, str]]], touching: Collection[str], it: str
) -> str:
    """Who touched a thing while another one moved it, and in how much of its motion."""
    shares: dict[int, list[str]] = defaultdict(list)
    for mover in sorted(touching):
        count = sum(any(who == mover for _, who in found) for found in frames.values())
        share = round(100.0 * count / len(frames))
        if share:
            shares[share].append(f"the {spoken(mover)}")
    return "".join(
        f"; {_few(who)} {'were' if len(who) > 1 else 'was'} in contact with {it} "
        + (f"for {share} % of that time" if share < ALL_BUT else "meanwhile")
        for share, who in sorted(shares.items(), reverse=True)
    )


def _without_contact(
    apart: Mapping[str, Sequence[int]], frames: Mapping[int, Collection[tuple[str, str]]], it: str
) -> str:
    """Who moved a thing, and in how much of that time, while no contact of the two counted."""
    told = []
    for who, held in apart.items():
        own = sum(any((how, who) in movers for how in BY_HAND) for movers in frames.values())
        share = round(100.0 * len(held) / own)
        when = f"for {share} % of the time in which" if share < ALL_BUT else "while"
        told.append(
            f"; {when} the {spoken(who)} moved {it}, the two were near each other and moved alike, "
            "but did not count as in contact"
        )
    return "".join(told)


def _movers(found: Collection[tuple[str, str]]) -> set[str]:
    """Who moves a thing: where one holds it steadily, who merely touches it does not."""
    holding = {mover for how, mover in found if how == "carried"}
    return holding or {mover for how, mover in found if how not in WITHOUT_MOVER}


def _touching(frames: Collection[Collection[tuple[str, str]]]) -> set[str]:
    """Who touched a thing in its motion and never held it, while another one moved it."""
    shares = Counter(mover for found in frames for mover in _movers(found))
    least = ALL_BUT / 100.0 * len(frames)
    throughout = {mover for mover, count in shares.items() if count >= least}
    moving = {(how, mover) for found in frames for how, mover in found}
    slipping = {mover for how, mover in moving if how == "pushed"}
    held = {mover for how, mover in moving if how not in ("pushed", *WITHOUT_MOVER)}
    return slipping - throughout - held if throughout else set()


def _without_mover(frames: Collection[Collection[tuple[str, str]]]) -> list[str]:
    hows = {how for found in frames for how, _ in found if how in WITHOUT_MOVER}
    return [WORDS[how] for how in sorted(hows)]


def _remainder(frames: Collection[Collection[tuple[str, str]]], *, it: str) -> str:
    """What is told of the time in which nothing moves it."""
    alone = [found for found in frames if not _movers(found)]
    share = round(100.0 * len(alone) / len(frames))
    return f"; for {share} % of the time {it} {' or '.join(_without_mover(alone))}" if share else ""


def _how_long(count: int, total: int) -> str:
    share = 100.0 * count / total
    return ALL_THE_TIME if share >= ALL_BUT else f" for {share:.0f} %{OF_TIME}"


def _together(movers: Collection[tuple[str, str]]) -> str:
    """What several movers do at once, those that do the same together."""
    found: dict[str, list[str]] = defaultdict(list)
    moving = _movers(movers)
    for how, mover in sorted(movers):
        if not moving or mover in moving:
            found[WORDS[how]].append(f"the {spoken(mover)}")
    told = {words: list(dict.fromkeys(who)) for words, who in found.items()}
    return joined([words.format(_few(who)) for words, who in told.items()])


def _few(who: Sequence[str]) -> str:
    """A few names, and how many others there are."""
    if len(who) <= MOST_TOLD + 1:
        return joined(who)
    return f"{', '.join(who[:MOST_TOLD])} and {len(who) - MOST_TOLD} others"


def joined(parts: Sequence[str]) -> str:
    """Parts as a list in words."""
    *most, last = parts
    return f"{', '.join(most)}{' and ' * bool(most)}{last}"
