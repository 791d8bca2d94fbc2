"""Clauses by sentence, in an order and with openings that agree with when everything was.

``Then`` opens a sentence only where all that was told before had ended; ``meanwhile`` where most
of what the sentence tells was done during that. What stands beside the first hand's deeds, after
``while``, was done during them, too.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

from kb.language.clause import Clause, in_time
from kb.language.lexicalisation import HANDED_OVER, REACH
from kb.language.repeating import repetition
from kb.language.thresholds import PAUSE_S, REST_S
from kb.lexicon.english import times

LONGEST = 6
"""The most clauses of one hand in a sentence."""

FEW = 2
"""So many clauses more may stand in a sentence that then ends with letting go."""

LONGEST_BESIDE = 4
"""The most clauses of another hand that stand beside them."""

ENOUGH_BESIDE = 2
"""After so many clauses that stand beside them, what the first hand does next is told for itself.
"""

ENOUGH_OF_ONE = 2
"""After so many clauses, what is done with another thing begins another sentence."""

OPENINGS = ("Then ", "Next, ", "After that, ")
"""How sentences begin that tell what was done afterwards, in turn."""

LATER = "Later, "
"""How a sentence begins after a noticed pause, where times are not told."""

ALSO = "Also, "
"""How a sentence begins that tells what the same hand did in between."""

MEANWHILE = "Meanwhile, "
"""How a sentence begins that tells what was done during what was told before."""

ONCE_MORE = "Once more, "
"""How a sentence begins that tells what was counted before."""

Paused = Mapping[float, float]
"""How long each noticed pause lasted [s], by when it ended [s]."""

Streams = dict[tuple[str, ...], list[Clause]]
"""What is still to be told, by end-effectors."""


@dataclass(frozen=True)
class Part:
    """The content of one sentence; what is repeated stands once, with how often and until when."""

    told: tuple[Clause, ...]
    """What the first hand did."""

    passed: tuple[tuple[Clause, ...], ...] = ()
    """What each hand then did to which the thing was handed over, one after the other."""

    beside: tuple[Clause, ...] = ()
    """What other hands did meanwhile."""

    often: str = ""
    end_s: float = 0.0
    """When the last of its clauses, or of their repetitions, ends."""

    opening: str = ""
    more: bool = False
    """Whether the next sentence tells what is counted here once more."""

    @property
    def steps(self) -> tuple[Clause, ...]:
        """Every clause."""
        return (*self.told, *(step for part in self.passed for step in part), *self.beside)


def sentences(
    steps: Sequence[Clause],
    *,
    lead: tuple[str, ...] = (),
    paused: Paused = MappingProxyType({}),
    timed: bool = False,
) -> list[Part]:
    """The clauses by sentence, each sentence with how it begins.

    Args:
        steps: What was done.
        lead: End-effectors whose deeds are told before those that others did meanwhile.
        paused: How long each noticed pause lasted [s], by when it ended [s].
        timed: Whether it is told how long they lasted.
    """
    streams: Streams = {}
    for clause in sorted(steps, key=in_time):
        streams.setdefault(clause.ees, []).append(clause)
    out: list[Part] = []
    afterwards = 0
    end_s = float("-inf")
    while any(streams.values()):
        part = _next_part(streams, lead, paused)
        opening = _opening(part, out, end_s, OPENINGS[afterwards % len(OPENINGS)])
        start_s = min(each.start_s for each in part.steps)
        waited_s = paused.get(start_s, start_s - end_s)
        if out and waited_s >= PAUSE_S and opening in OPENINGS:
            opening = f"About {waited_s:.0f} s later, " if timed else LATER
        if opening == ONCE_MORE:
            out[-1] = replace(out[-1], more=True)
        afterwards = afterwards + 1 if opening in OPENINGS else 0
        out.append(replace(part, opening=opening))
        end_s = max(end_s, part.end_s)
    return out


def _opening(part: Part, told: Sequence[Part], end_s: float, afterwards: str) -> str:
    if not told:
        return ""
    start_s = min(each.start_s for each in part.steps)
    if start_s >= end_s:
        before = told[-1]
        recurs = before.often and _said(part.steps) == _said(before.steps)[: len(part.steps)]
        return ONCE_MORE if recurs else afterwards
    if all(each.ees == part.told[0].ees for each in (*part.steps, *told[-1].steps)):
        return ALSO if part.end_s < end_s else ""
    during = min(part.end_s, end_s) - start_s
    return MEANWHILE if during >= 0.5 * (part.end_s - start_s) else ""


def _said(steps: Sequence[Clause]) -> list[tuple[object, ...]]:
    return [(each.signature, each.ees) for each in steps]


def _next_part(streams: Streams, lead: tuple[str, ...], paused: Paused) -> Part:
    """What the next sentence tells; it is taken from what is still to be told."""
    waiting = [key for key, rest in streams.items() if rest]
    ees = min(waiting, key=lambda key: in_time(streams[key][0]))
    if lead in waiting and _goes_first(streams[lead][0], streams[ees][0]):
        ees = lead
    own = streams[ees]
    size, count = _repeated(streams, ees, 0)
    if count > 1:
        block, end_s = own[:size], own[size * count - 1].end_s
        del own[: size * count]
        return Part(tuple(block), often=times(count), end_s=end_s)
    taken = _taken(streams, ees, paused)
    beside = [
        clause
        for other, rest in streams.items()
        if rest and not set(other) & set(ees)
        for clause in _beside(taken, rest, streams)
    ]
    part = Part(tuple(taken), beside=tuple(beside))
    passed = () if beside else tuple(map(tuple, _passed(taken, streams, paused)))
    part = replace(part, passed=passed)
    return replace(part, end_s=max(each.end_s for each in part.steps))


def _taken(streams: Streams, ees: tuple[str, ...], paused: Paused) -> list[Clause]:
    """What one sentence tells of some hand; it is taken from what is still to be told."""
    own = streams[ees]
    taken = [own.pop(0)]
    while own and own[0].start_s not in paused and not _ends(taken, streams, ees):
        taken.append(own.pop(0))
    return taken


def _passed(taken: Sequence[Clause], streams: Streams, paused: Paused) -> Iterator[list[Clause]]:
    """What hands do to which a thing is handed over, as long as that is what comes next."""
    last = taken[-1]
    while (ees := _receiver(last, streams)) is not None:
        stream = _taken(streams, ees, paused)
        yield stream
        last = stream[-1]


def _receiver(giving: Clause, streams: Streams) -> tuple[str, ...] | None:
    """The other hand of which nothing earlier is to be told than that it has what is handed over.

    None where the thing is not handed over, or something else is to be told first.
    """
    if giving.pattern not in HANDED_OVER:
        return None
    waiting = {ees: rest[0] for ees, rest in streams.items() if rest}
    takes = [
        ees
        for ees, following in waiting.items()
        if len(ees) == 1
        and ees != giving.ees
        and following.objects[:1] == giving.objects[:1]
        and following.possessed
        and giving.start_s - REST_S < following.start_s < giving.end_s + REST_S
        and all(in_time(following) <= in_time(other) for other in waiting.values())
    ]
    return takes[0] if takes else None


def _goes_first(leading: Clause, earliest: Clause) -> bool:
    """Whether what is to be told first was done beside the earliest deed, with another thing."""
    meanwhile = leading.start_s < earliest.end_s
    return meanwhile and leading.objects[:1] != earliest.objects[:1]


def _repeated(streams: Streams, ees: tuple[str, ...], at: int) -> tuple[int, int]:
    """What recurs in a stream from a place on, where no other hand does anything meanwhile."""
    own = streams[ees]
    size, count = repetition(own, at, longest=LONGEST)
    if count == 1:
        return 1, 1
    end_s = own[at + size * count - 1].end_s
    others = (rest for other, rest in streams.items() if other != ees)
    alone = not any(each.start_s < end_s for rest in others for each in rest)
    return (size, count) if alone else (1, 1)


def _ends(taken: Sequence[Clause], streams: Streams, ees: tuple[str, ...]) -> bool:
    """Whether a sentence ends before the next clause of its first hand.

    It does when it is long, when the hand has let go, when it turns to another thing after enough
    was told of the first, when another hand helped with it meanwhile, and when as much was done
    meanwhile as can stand beside it.
    """
    last, following = taken[-1], streams[ees][0]
    if _leads_to(last, following) or any(following.within(each) for each in taken):
        return False
    if (last.start_s, last.end_s) == (following.start_s, following.end_s):
        return False
    long = len(taken) >= LONGEST and following.objects and not _soon_over(streams[ees])
    left = (last.frees or _goes_on_beyond(last, following)) and bool(following.objects)
    if left or _turns_away(taken, following) or long or _crowded(taken, following):
        return True
    manual = [each for each in taken if each.objects]
    if following.objects and last.grip != following.grip and len(manual) >= ENOUGH_OF_ONE:
        return True
    recurs = _repeated(streams, ees, 0)[1] > 1
    if recurs or _waits(following, streams) or _changes_hands(last, following, streams):
        return True
    waiting = [
        each
        for other, rest in streams.items()
        if not set(other) & set(ees)
        for each in rest
        if each.end_s <= following.start_s
    ]
    apart = any(not _during(each, taken) for each in waiting)
    helped = any(each.objects[:1] == last.objects[:1] for each in waiting)
    return apart or helped or len(waiting) >= ENOUGH_BESIDE


def _goes_on_beyond(last: Clause, following: Clause) -> bool:
    """Whether what is done with things goes on after the next is over."""
    return bool(last.objects) and following.end_s < last.end_s


def _crowded(taken: Sequence[Clause], following: Clause) -> bool:
    """Whether lists of things would be too long for one sentence."""
    several = [clause for clause in (*taken, following) if clause.apart]
    things = sum(max(len(clause.apart), 1) for clause in (*taken, following))
    return bool(several) and things > LONGEST


def _soon_over(rest: Sequence[Clause]) -> bool:
    """Whether the hand lets go of what it has within few clauses."""
    return any(each.frees and each.grip == rest[0].grip for each in rest[:FEW])


def _waits(clause: Clause, streams: Streams) -> bool:
    """Whether something is to be told first that one of its hands did before."""
    return any(
        each.start_s < clause.start_s
        for other, rest in streams.items()
        if other != clause.ees and set(other) & set(clause.ees)
        for each in rest
    )


def _changes_hands(last: Clause, following: Clause, streams: Streams) -> bool:
    """Whether another hand had the thing before this hand has it again."""
    return last.grip != following.grip and any(
        each.possessed
        and each.objects[:1] == following.objects[:1]
        and each.start_s < following.start_s
        for ees, rest in streams.items()
        if not set(ees) & set(following.ees)
        for each in rest
    )


def _turns_away(told: Sequence[Clause], following: Clause) -> bool:
    own = [each for each in told if each.objects]
    if len(own) < ENOUGH_OF_ONE or not following.objects:
        return False
    return own[-1].objects[:1] != following.objects[:1]


def _beside(taken: Sequence[Clause], rest: list[Clause], streams: Streams) -> list[Clause]:
    """What another hand did during those clauses; it is taken from what is still to be told."""
    size = 0
    while size < min(len(rest), LONGEST_BESIDE) and _during(rest[size], taken):
        if _waits(rest[size], streams):
            break
        size += 1
    if size == LONGEST_BESIDE and size < len(rest):
        last = rest[size]
        if last.frees and _during(last, taken) and not _waits(last, streams):
            size += 1
        else:
            size = _up_to_another_thing(rest, size)
    while 0 < size < len(rest) and _leads_to(rest[size - 1], rest[size]):
        size -= 1
    found, rest[:] = rest[:size], rest[size:]
    return found


def _leads_to(clause: Clause, following: Clause) -> bool:
    """Whether a hand reaches for what it has next: one is not told without the other."""
    reaches = clause.pattern == REACH and not following.comes
    return reaches and clause.objects[:1] == following.objects[:1]


def _during(clause: Clause, taken: Sequence[Clause]) -> bool:
    """Whether most of a clause falls into the time of others."""
    start_s, end_s = taken[0].start_s, max(each.end_s for each in taken)
    shared = min(clause.end_s, end_s) - max(clause.start_s, start_s)
    return start_s <= clause.start_s < end_s and shared >= 0.5 * (clause.end_s - clause.start_s)


def _up_to_another_thing(rest: Sequence[Clause], size: int) -> int:
    """Fewer clauses, where those end as the hand turns to another thing."""
    for fewer in range(size, 1, -1):
        if rest[fewer].objects[:1] != rest[fewer - 1].objects[:1]:
            return fewer
    return size
