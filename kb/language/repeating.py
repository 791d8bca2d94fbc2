"""Clauses of segments as deeds: what adjoins is one deed, scraps go with it, and pauses count."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import accumulate

from kb.language.clause import Clause
from kb.language.contacts import Scene
from kb.language.lexicalisation import (
    LOWER,
    MOVING,
    RAISE,
    RUNNING,
    SHIFTED,
    THIS_WAY,
    TILT,
    TIPPED,
    TURN,
)
from kb.language.thresholds import REST_S, SCRAP_M, SCRAP_S, SETTLING_S, TO_AND_FRO_RAD, UNSEEN_S
from kb.language.turning import Turning


def deeds(told: Sequence[Clause], scene: Scene, turning: Turning) -> tuple[Clause, ...]:
    """The clauses of one hand, with segments of one deed as one clause.

    Args:
        told: What the hand did, segment by segment.
        scene: Measured contacts and places.
        turning: How things are turned.
    """
    joined = _resumed(leading_up(_specialised(_resumed(told, scene))), scene)
    found = _resumed(leading_up(_reached(_without_scraps(joined, scene))), scene)
    return _gripped(_turned_on(_steadied(found), scene, turning))


def as_segmented(told: Sequence[Clause]) -> tuple[Clause, ...]:
    """The clauses, each segment by itself but those that say the same on end."""
    return _gripped(_resumed(told))


def _gripped(told: Sequence[Clause]) -> tuple[Clause, ...]:
    """The clauses, each with how often the hand had come to a thing by then."""
    comes = [clause.comes or (at > 0 and told[at - 1].frees) for at, clause in enumerate(told)]
    return tuple(replace(each, grip=at) for each, at in zip(told, accumulate(comes), strict=True))


def _steadied(told: Sequence[Clause]) -> list[Clause]:
    """The clauses, without a hand's staying at a thing that it steadies then."""
    out: list[Clause] = []
    for clause in told:
        last = out[-1] if out else None
        held = last is not None and last.pattern.startswith("hold {1}")
        if last is not None and held and clause.helps and last.objects[:1] == clause.objects[:1]:
            out[-1] = clause
        else:
            out.append(clause)
    return out


def _turned_on(told: Sequence[Clause], scene: Scene, turning: Turning) -> list[Clause]:
    """The clauses, with what turns a thing just before or after it is turned about as that, too."""
    out: list[Clause] = []
    for clause in told:
        if out and _turns_on(out[-1], clause, scene, turning):
            out[-1] = replace(
                out[-1],
                pattern=THIS_WAY,
                name="Turn",
                end_s=clause.end_s,
                rights=clause.rights,
            )
        else:
            out.append(clause)
    return out


def _turns_on(last: Clause, clause: Clause, scene: Scene, turning: Turning) -> bool:
    """Whether both turn the same thing in one grip, and one of them turns it about."""
    moved = all(step.changes and step.possessed for step in (last, clause))
    soon = clause.start_s - last.end_s < SETTLING_S
    if not (moved and soon) or last.objects != clause.objects:
        return False
    if _set_down(last, scene):
        return False
    others = [step for step in (last, clause) if step.pattern != THIS_WAY]
    return len(others) < 2 and all(_turns(step, scene, turning) for step in others)


def _turns(step: Clause, scene: Scene, turning: Turning) -> bool:
    """Whether it is turning or tilting, or goes up or down and turns the thing much meanwhile."""
    thing = step.objects[0]
    if step.pattern == LOWER and scene.left_there(thing, step.end_s):
        return False
    turned_rad = turning.turned_rad(thing, step.start_s, step.end_s)
    rises = step.pattern in {RAISE, LOWER} and turned_rad > TO_AND_FRO_RAD
    return rises or step.pattern in {TURN, TILT}


def _resumed(told: Sequence[Clause], scene: Scene | None = None) -> list[Clause]:
    """The clauses, with each deed that goes on, at once or after pauses in the grip, as one.

    A thing that was set down in between is not done the same to all the time.

    Args:
        told: What one hand did.
        scene: Measured contacts and places; None where only what goes on at once is one deed.
    """
    out: list[Clause] = []
    at = 0
    while at < len(told):
        deed = told[at]
        at += 1
        while at < len(told):
            pause: tuple[Clause, ...] = ()
            if (
                scene is not None
                and at + 1 < len(told)
                and deed.changes
                and _pauses(deed, told[at])
            ):
                pause = (told[at],)
            following = told[at + len(pause)]
            if not _same(deed, following) or (scene is not None and _set_down(deed, scene)):
                break
            deed = _continued(deed, pause, following)
            at += len(pause) + 1
        out.append(deed)
    return out


def _set_down(deed: Clause, scene: Scene) -> bool:
    """Whether a thing that was turned stands at the end where it is left, and did not before."""
    turned = deed.pattern in {THIS_WAY, TURN, TILT} and deed.possessed
    return turned and scene.sets_down(deed.objects[0], deed.start_s, deed.end_s)


def _same(deed: Clause, following: Clause) -> bool:
    """Whether a clause says what another said, or less of it."""
    if following.pattern == deed.pattern and following.purpose == deed.purpose:
        return _named(deed) == _named(following)
    less = more_of(deed, following) and deed.pattern in TIPPED
    return less and not following.purpose


def _named(clause: Clause) -> tuple[str, ...]:
    """The objects that the clause names."""
    every = enumerate(clause.objects, 1)
    return tuple(name for place, name in every if place == 1 or f"{{{place}}}" in clause.pattern)


def _continued(deed: Clause, pause: Sequence[Clause], following: Clause) -> Clause:
    """A deed with what follows as one; what ends otherwise than it began was done once more.

    So was what is poured after the vessel was upright; while it is held tipped, it is poured from.
    """
    tipped = deed.pattern in TIPPED
    rests = tuple(
        (each.start_s, each.end_s)
        for each in pause
        if not tipped and each.end_s - each.start_s >= REST_S
    )
    anew = deed.rights if tipped else deed.changes and not deed.goes_on
    again = following.count if anew else 0
    return replace(
        deed,
        end_s=following.end_s,
        pauses=deed.pauses + len(rests) + following.pauses,
        rests=(*deed.rests, *rests, *following.rests),
        count=deed.count + again,
        rights=following.rights,
    )


def _pauses(deed: Clause, clause: Clause) -> bool:
    """Whether the hand only stays at the thing, which stays in the grip."""
    return clause.possessed and clause.holds and clause.objects[:1] == deed.objects[:1]


def more_of(clause: Clause, other: Clause) -> bool:
    """Whether it says what the other says, and where to."""
    lowers = other.pattern == LOWER and clause.pattern.startswith("put {1}")
    longer = lowers or clause.pattern.startswith(f"{other.pattern} ")
    return longer and clause.objects[:1] == other.objects[:1] and not other.purpose


def leading_up(told: Sequence[Clause]) -> list[Clause]:
    """The clauses, without one that the next says more of: ``move it``, ``move it to the bowl``."""
    out: list[Clause] = []
    for clause in told:
        same = bool(out) and more_of(clause, out[-1]) and out[-1].count == 1
        out.append(replace(clause, start_s=out.pop().start_s) if same else clause)
    return out


def _specialised(told: Sequence[Clause]) -> list[Clause]:
    """The clauses, without one that says the end of the last in a more general word.

    Who lifts a thing off a table raises it on: ``lifted it``. The most general words, which
    specialise nothing, say something else.
    """
    out: list[Clause] = []
    for clause in told:
        last = out[-1] if out else None
        if last is not None and _goes_on_with(last, clause):
            out[-1] = replace(last, end_s=clause.end_s, rights=clause.rights)
        else:
            out.append(clause)
    return out


def _goes_on_with(last: Clause, clause: Clause) -> bool:
    more = last.general[:1] == (clause.name,) and bool(clause.general)
    same = last.objects == clause.objects and clause.changes and not clause.purpose
    return more and same and last.count == clause.count == 1


def _without_scraps(told: Sequence[Clause], scene: Scene) -> list[Clause]:
    """The clauses, with each scrap of a motion in what it belongs to, and no short hold."""
    waiting = [
        each for at, each in enumerate(told) if not (_short_hold(told, at) or _only_there(told, at))
    ]
    out: list[Clause] = []
    while waiting:
        clause = waiting.pop(0)
        following = waiting[0] if waiting else None
        if not _scrap(clause, following, scene):
            out.append(clause)
        elif following is not None and _takes_up(clause, following):
            waiting[0] = replace(following, start_s=clause.start_s)
        elif out and out[-1].changes and _one_grip(out[-1], clause):
            out[-1] = replace(out[-1], end_s=clause.end_s, rights=clause.rights)
        else:
            out.append(clause)
    return out


def _only_there(told: Sequence[Clause], at: int) -> bool:
    """Whether a hand that does more with a thing only is at it, or stays at what it put down."""
    clause = told[at]
    beside = [*told[max(at - 1, 0) : at], *told[at + 1 : at + 2]]
    same = [each for each in beside if each.objects[:1] == clause.objects[:1]]
    if clause.pattern == RUNNING:
        return any(each.changes for each in same)
    brief = clause.end_s - clause.start_s < SETTLING_S
    leaves = at + 1 < len(told) and told[at + 1].pattern == "let go of {1}"
    return clause.holds and brief and leaves and len(same) > 1 and same[0].changes


def _short_hold(told: Sequence[Clause], at: int) -> bool:
    """Whether it holds for a moment what it moves before or afterwards, as in taking hold of it."""
    clause = told[at]
    if not _pauses(clause, clause):
        return False
    before, after = told[max(at - 1, 0) : at], told[at + 1 : at + 2]
    changing = [each.changes and _one_grip(each, clause) for each in (*before, *after)]
    grasps = not any(_one_grip(each, clause) for each in before) and any(changing)
    lasts_s = clause.end_s - clause.start_s
    return lasts_s < (SETTLING_S if grasps or sum(changing) == 2 else SCRAP_S) and any(changing)


def _scrap(clause: Clause, following: Clause | None, scene: Scene) -> bool:
    """Whether it is a short motion in the grip that goes hardly anywhere, or with the next."""
    if _unseen(clause):
        return True
    moves = not MOVING.isdisjoint((clause.name, *clause.general))
    if not (moves and clause.changes and clause.possessed and clause.goes_on and clause.known):
        return False
    moved = clause.pattern.split()[1:2] == ["{1}"]
    brief = clause.end_s - clause.start_s < SCRAP_S
    only_moved = clause.pattern == "move {1}"
    if clause.purpose or not moved or not (brief or only_moved):
        return False
    if brief and only_moved:
        return True
    if following is not None and _takes_up(clause, following) and not following.goes_on:
        return True
    way = scene.strays_m if only_moved else scene.way_m
    gone_m = way(clause.objects[0], clause.start_s, clause.end_s)
    return gone_m is not None and gone_m < SCRAP_M


def _unseen(clause: Clause) -> bool:
    """Whether what the hand does with a thing that it goes on having is over before it is seen."""
    keeps = clause.possessed and (clause.goes_on or clause.name == "MoveObjTo")
    told = clause.purpose or not clause.known
    return keeps and clause.changes and not told and clause.end_s - clause.start_s < UNSEEN_S


def _takes_up(scrap: Clause, following: Clause) -> bool:
    """Whether a motion goes on with what a scrap began; working at a place does not."""
    slid = following.name in SHIFTED
    works = following.goes_on and len(following.objects) > 1 and not slid
    return following.changes and not works and _one_grip(scrap, following)


def _one_grip(one: Clause, other: Clause) -> bool:
    """Whether both are of one thing in the hand, with no noticed time between them."""
    near = max(one.start_s, other.start_s) - min(one.end_s, other.end_s) < SCRAP_S
    return near and one.possessed and other.possessed and one.objects[:1] == other.objects[:1]


def _reached(told: Sequence[Clause]) -> list[Clause]:
    """The clauses, with a hand that is taken from one thing straight to another as reaching."""
    out: list[Clause] = []
    for clause in told:
        short = clause.end_s - clause.start_s < SCRAP_S
        last = out[-1] if out else None
        if (
            last is not None
            and short
            and clause.pattern == "reach for {1}"
            and last.pattern == "take {ee} away"
            and last.objects != clause.objects
            and last.end_s == clause.start_s
        ):
            out[-1] = replace(clause, start_s=last.start_s)
        else:
            out.append(clause)
    return out


def whole(run: Sequence[Clause], *, count: int = 1, pattern: str = "") -> Clause:
    """One clause for all of a run, said as its first."""
    return replace(
        run[0],
        pattern=pattern or run[0].pattern,
        start_s=min(each.start_s for each in run),
        end_s=max(each.end_s for each in run),
        changes=any(each.changes for each in run),
        count=count,
        pauses=0,
        rests=(),
    )


def repetition(steps: Sequence[Clause], at: int, *, longest: int) -> tuple[int, int]:
    """The length of the block that is repeated from here, and how often it stands; else (1, 1)."""
    best = (1, 1)
    for size in range(1, longest + 1):
        block = _said(steps[at : at + size])
        count = 1
        while block == _said(steps[at + size * count : at + size * (count + 1)]):
            count += 1
        if count > 1 and size * count > best[0] * best[1]:
            best = (size, count)
    return best


def _said(steps: Sequence[Clause]) -> list[tuple[object, ...]]:
    return [(each.signature, each.ees) for each in steps]
