"""Clauses as a writer would leave them: repetition counted, verbs of one thing joined."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import groupby

from kb.language.clause import Clause, in_time
from kb.language.lexicalisation import JOINT, THIS_WAY
from kb.language.repeating import leading_up, more_of, repetition, whole

MOST_VERBS = 4
"""The most verbs that share their object."""

RECALLED = 2
"""After how many other clauses one that says the same is no longer said to be done again."""


def edited(steps: Sequence[Clause]) -> tuple[Clause, ...]:
    """The clauses without monotony; none of them is left untold.

    What a hand does to one thing alone is joined (``raised, tilted, and lowered it``), and what
    recurs is counted. What both hands do together is joined only with what they do together next.
    """
    out: list[Clause] = []
    for _, part in groupby(steps, key=lambda each: len(each.ees) > 1):
        streams: dict[tuple[str, ...], list[Clause]] = {}
        for clause in part:
            streams.setdefault(clause.ees, []).append(clause)
        found = [
            clause
            for told in streams.values()
            for clause in _plain_runs(leading_up(told), _joined_run)
        ]
        out += sorted(found, key=in_time)
    return _again(out)


def _plain_runs(
    told: Sequence[Clause], joint: Callable[[list[Clause]], list[Clause]]
) -> list[Clause]:
    """The clauses, with each run of bare verbs over one thing joined."""
    out: list[Clause] = []
    for (plain, *_), same in groupby(told, key=_of_one_run):
        run = list(same)
        out += joint(run) if plain else run
    return out


def _of_one_run(clause: Clause) -> tuple[object, ...]:
    """What clauses have in common that may be joined."""
    return _plain(clause), clause.objects, clause.grip


def _plain(clause: Clause) -> bool:
    """Whether it says a single verb of a single thing: ``turn {1}``."""
    verb, _, rest = clause.pattern.partition(" ")
    said = clause.purpose or clause.often or clause.pauses
    return bool(verb) and rest == "{1}" and not said and JOINT not in verb


def _verb(clause: Clause) -> str:
    return clause.pattern.partition(" ")[0]


def _joined_run(run: list[Clause]) -> list[Clause]:
    """Blocks that recur, counted; between them, verbs that share their object."""
    out: list[Clause] = []
    loose: list[Clause] = []
    at = 0
    while at < len(run):
        size, count = repetition(run, at, longest=MOST_VERBS)
        if size > 1 and any(each.count > 1 for each in run[at : at + size]):
            size, count = 1, 1
        block = run[at : at + size * count]
        if count > 1 or run[at].count > 1:
            out += [*_shared(loose), _repeated(block, size, count)]
            loose = []
        else:
            loose += block
        at += size * count
    return [*out, *_shared(loose)]


def _repeated(block: Sequence[Clause], size: int, count: int) -> Clause:
    if count == 1:
        return block[0]
    verbs = JOINT.join(map(_verb, block[:size]))
    return whole(block, count=count, pattern=f"{verbs} {{1}}")


def _shared(loose: Sequence[Clause]) -> list[Clause]:
    """Three different verbs or more on end, in groups whose object is said once."""
    groups: list[list[Clause]] = []
    for clause in loose:
        current = groups[-1] if groups else []
        known = _verb(clause) in map(_verb, current)
        if not current or known or len(current) == MOST_VERBS:
            groups.append([clause])
        else:
            current.append(clause)
    return [clause for group in groups for clause in _sharing(group)]


def _sharing(group: Sequence[Clause]) -> list[Clause]:
    if len(group) < 3:
        return list(group)
    return [whole(group, pattern=f"{JOINT.join(map(_verb, group))} {{1}}")]


def _again(told: Sequence[Clause]) -> tuple[Clause, ...]:
    """The clauses, with what a hand did shortly before said to be done again."""
    out: list[Clause] = []
    for clause in told:
        own = [each for each in out if each.ees == clause.ees][-RECALLED:]
        once = clause.changes and clause.known and clause.count == 1 and not clause.often
        again = (
            once and clause.pattern != THIS_WAY and any(_same_deed(other, clause) for other in own)
        )
        out.append(replace(clause, often="again") if again else clause)
    return tuple(out)


def _same_deed(one: Clause, other: Clause) -> bool:
    if one.pattern == other.pattern:
        return one.objects == other.objects
    if THIS_WAY in (one.pattern, other.pattern):
        return False
    return more_of(one, other) or more_of(other, one)
