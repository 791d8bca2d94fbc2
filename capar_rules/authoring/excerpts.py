"""Short examples: what was measured about one segment, cut to the facts that its names need."""

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import fields, replace

from capar.model.facts import Fact, Frames, Link, RateMhz, Tag, Touching, program
from capar.model.observation import ObservedLink, Segment
from capar.model.par import UNKNOWN
from capar_rules.borders.border_numbers import number_borders
from capar_rules.engine.profiles import Profile
from capar_rules.engine.search import worlds
from capar_rules.engine.slicing import towards
from capar_rules.engine.syntax import parse, split_arguments

MOST_FACTS = 36
"""A longer example is shortened further; with its lines of story and names it has 40 lines."""

MARGIN = 1
"""How many segments before and after it an excerpt contains."""

Names = tuple[str, ...]
"""What an end-effector does, in order."""


def excerpt(
    facts: Sequence[Fact],
    link: ObservedLink,
    segment: Segment,
    *,
    rules: Profile,
    name: str,
    kept: Collection[str] = (),
) -> tuple[tuple[Fact, ...], Names] | None:
    """Facts about a segment and its neighbours, as few as name it alike, and the names they give.

    Args:
        facts: What was measured of the capture.
        link: What the end-effector does in it, by these rules.
        segment: One of the link's segments.
        rules: The rules, the drafted one among them.
        name: Which name must be given as often as the rules give it to the whole excerpt.
        kept: Predicates whose facts stay even where the names do not need them: in a long excerpt
            those at the borders of its segments, in one too long with these none.

    Returns:
        The facts, with frames counted from the excerpt's first one; None if no cut keeps the name.
    """
    at = link.segments.index(segment)
    naming = _naming_rules(rules)
    for margin in (MARGIN, 2 * MARGIN, len(link.segments)):
        near = link.segments[max(at - margin, 0) : at + margin + 1]
        wanted = sum(each.name == name for each in near)
        cut = tuple(_cut(facts, link.ee, near[0].first, near[-1].last))

        def told(some: Sequence[Fact], wanted: int = wanted) -> Names | None:
            names = _names(naming, some, rules)
            return names if names.count(name) == wanted else None

        if told(cut) == tuple(each.name for each in near):
            borders = {frame - near[0].first for each in near for frame in (each.first, each.last)}
            staying = {
                str(each)
                for each in cut
                if type(each).predicate in kept and getattr(each, "frame", 0) in {0, *borders}
            }
            few = _shortened(cut, told, kept, staying)
            return few, told(few) or ()
    return None


def _naming_rules(rules: Profile) -> str:
    """The rules by which segments are cut and named, without those for all else."""
    kept = towards(parse(rules.files), (("named", 2), ("segment", 3)))
    return "\n".join([*(each.text for each in kept), "#show named/2.\n#show segment/3."])


def _names(naming: str, facts: Sequence[Fact], rules: Profile) -> Names:
    """What the one end-effector of an excerpt does, in order."""
    numbered = number_borders(facts, crossings_only=rules.crossings_only)
    (atoms,) = worlds(f"{naming}\n{program((*facts, *numbered))}")
    begins: dict[str, int] = {}
    names: dict[str, str] = {}
    for atom in atoms:
        arguments = split_arguments(atom)
        if atom.startswith("segment("):
            begins[arguments[0]] = int(arguments[1])
        else:
            names.setdefault(arguments[0], arguments[1].strip('"'))
    return tuple(names.get(each, UNKNOWN) for each in sorted(begins, key=begins.__getitem__))


def _cut(facts: Sequence[Fact], ee: str, first: int, last: int) -> Iterator[Fact]:
    """What concerns one end-effector between two frames, which are counted from the first."""
    touches = [each for each in facts if isinstance(each, Touching)]
    held = {each.other for each in touches if each.body == ee and _meets(each, first, last)}
    about = {ee} | held | {each.other for each in touches if each.body in held}
    about |= {each.body for each in touches if each.other in held and each.body in about}
    kept = {(each.body, each.other, each.first) for each in touches if _meets(each, first, last)}
    for fact in facts:
        if isinstance(fact, Frames):
            yield Frames(0, last - first)
        elif isinstance(fact, RateMhz) or not fields(fact):
            yield fact
        elif isinstance(fact, Link):
            if fact.ee == ee:
                yield fact
        elif _bodies(fact) <= about and _meets(fact, first, last, kept):
            yield _shifted(fact, first, last)


def _bodies(fact: Fact) -> set[str]:
    """The bodies of a fact: its texts in fields that name one."""
    named = ("ee", "body", "other", "object", "base", "first_other", "second_other", "sensor")
    return {str(getattr(fact, each)) for each in named if hasattr(fact, each)} - {""}


def _meets(fact: Fact, first: int, last: int, kept: Iterable[tuple[str, str, int]] = ()) -> bool:
    """Whether it holds at some time between the frames; of a contact, whether that one does."""
    if hasattr(fact, "frame"):
        return bool(first <= fact.frame <= last)
    if hasattr(fact, "first") and hasattr(fact, "last"):
        return bool(fact.first < last and fact.last > first)
    if hasattr(fact, "first"):
        return any(since == fact.first for _, _, since in kept)
    return True


def _shifted(fact: Fact, first: int, last: int) -> Fact:
    moved = {
        key: min(max(getattr(fact, key) - first, 0), last - first)
        for key in ("first", "last", "frame")
        if hasattr(fact, key)
    }
    return replace(fact, **moved) if moved else fact


def _shortened(
    facts: tuple[Fact, ...],
    told: Callable[[Sequence[Fact]], Names | None],
    kept: Collection[str],
    staying: Collection[str],
) -> tuple[Fact, ...]:
    """Fewer facts of which the same is told: whole kinds go first, then some of what is left."""
    names = told(facts)

    def alike(some: Sequence[Fact]) -> bool:
        return told(some) == names

    kinds = sorted({type(each).predicate for each in facts} - {*NEEDED, *kept})
    few = _without(facts, [{each} for each in kinds], alike, key=lambda each: type(each).predicate)
    spare = [each for each in few if type(each).predicate not in NEEDED]
    for some in ([each for each in spare if str(each) not in staying], spare):
        if len(few) > MOST_FACTS:
            few = _without(few, [{str(each)} for each in some], alike, key=str)
    return few


def _without(
    facts: tuple[Fact, ...],
    groups: Sequence[set[str]],
    alike: Callable[[Sequence[Fact]], bool],
    *,
    key: Callable[[Fact], str],
) -> tuple[Fact, ...]:
    """The facts without those groups that nothing needs, found by halving what is left out."""
    if not groups:
        return facts
    out = set[str]().union(*groups)
    rest = tuple(each for each in facts if key(each) not in out)
    if alike(rest):
        return rest
    if len(groups) == 1:
        return facts
    middle = len(groups) // 2
    return _without(
        _without(facts, groups[:middle], alike, key=key), groups[middle:], alike, key=key
    )


NEEDED = tuple(each.predicate for each in (Frames, RateMhz, Link, Tag, Touching))
"""Predicates without which an example tells no story."""
