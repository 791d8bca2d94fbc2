"""The shortest plan that prepares an action, found by the solver over what was recorded."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from capar.model.capture import TagType
from capar.model.errors import RuleError
from capar.pipelines.preparation_facts import Place, places_of, way_facts, world_facts
from capar.pipelines.preparing import Condition, Problem, told
from capar.pipelines.ways import Way
from capar.regeneration.free_places import Spot
from capar_rules.engine.solver import Answer, Term, best, rule_file, text_of

MOST_STEPS = 16
"""A plan has no more steps than this [1]."""

PROGRAM = "planning/preparing.lp"

Failed = tuple[str, str, str, Term]
"""A recording, a hand, a thing and a place, or ``any``, that were tried and are not possible."""


@dataclass(frozen=True)
class Planned:
    """A step of a plan."""

    action: str
    hand: str
    thing: str
    recording: str
    number: int
    """Of the step in its recording."""

    place: Spot | None
    """Where it puts the thing [m]; None where it puts nothing."""

    support: str = ""


@dataclass(frozen=True, eq=False)
class Stage:
    """Steps that one recording does in a row."""

    way: Way
    steps: tuple[Planned, ...]
    term: Term
    """The place as the solver calls it, or ``any``."""

    touching: frozenset[tuple[str, str]]
    """Which hands touch what after it, as the plan has it."""

    @property
    def goal(self) -> Planned | None:
        """The last step that puts the thing somewhere."""
        return next((step for step in reversed(self.steps) if step.place is not None), None)

    @property
    def failed(self) -> Failed:
        """What is ruled out when it is not possible."""
        return self.way.recording.name, self.steps[0].hand, self.steps[0].thing, self.term


def unmet(problem: Problem) -> tuple[Condition, ...]:
    """What an action needs and its world lacks."""
    return _unmet(_solved([*world_facts(problem, ())], 0))


def shortest(
    problem: Problem, ways: Sequence[Way], failed: Iterable[Failed] = ()
) -> tuple[tuple[Stage, ...], tuple[Condition, ...]]:
    """The shortest plan that makes true all that is wanted.

    Args:
        problem: What is wanted.
        ways: What can be done.
        failed: What was tried and is not possible.

    Returns:
        What recordings do, in order, and what no plan makes true; one of them is empty.
    """
    places = places_of(problem, ways)
    facts = [*world_facts(problem, places), *way_facts(problem, ways, places)]
    facts += [f"{text_of(('failed', *row))}." for row in failed]
    left = unmet(problem)
    for steps in range(1, MOST_STEPS + 1) if left else ():
        try:
            answer = _solved(facts, steps)
        except RuleError:
            continue  # there are no so many steps
        rest = _unmet(answer)
        if not rest:
            return _stages(answer, ways, places), ()
        left = min(left, rest, key=len)
    return (), left


def why_unmet(problem: Problem, conditions: Sequence[Condition], ways: Sequence[Way]) -> str:
    """Which conditions do not hold, and what would make them hold."""
    return "; ".join(_why(problem, condition, ways) for condition in conditions)


def _why(problem: Problem, condition: Condition, ways: Sequence[Way]) -> str:
    scene, said = problem.world.scene, f"{told(condition)} does not hold"
    known = ", ".join(sorted({way.recording.name for way in ways})) or "none"
    if condition[0] == "clear":
        name = condition[1]
        near = problem.room.near({name: problem.goals[name]}, 0.01)
        there = sorted({other for pair in near if name in pair for other in pair - {name}})
        there = [other for other in there if other not in problem.parts]
        fixed = [other for other in there if scene.thing(other).tag is TagType.FIXED]
        if fixed:
            return (
                f"{said}: {fixed[0]!r} is there and is fixed; another place for {name!r} would do"
            )
        return (
            f"{said}: {', '.join(there)} is there, and no recording puts it elsewhere within reach "
            f"(tried: {known}); a recording that carries such a thing, or more room, would do"
        )
    return (
        f"{said}, and no recording makes it so (tried: {known}); a recording of one hand that does "
        "with such a thing, or a scene in which it holds, would do"
    )


def _solved(facts: Sequence[str], steps: int) -> Answer:
    return best([rule_file(PROGRAM)], "\n".join([*facts, f"horizon({steps})."]))


def _unmet(answer: Answer) -> tuple[Condition, ...]:
    found = (row[0] for row in answer.of("unmet"))
    return tuple(tuple(map(str, one)) for one in found if isinstance(one, tuple))


def _stages(answer: Answer, ways: Sequence[Way], places: Sequence[Place]) -> tuple[Stage, ...]:
    by_name = {way.recording.name: way for way in ways}
    by_term = {place.term: place for place in places}
    brought = {(time, thing): by_term[term] for time, thing, term in answer.of("brings")}
    rows: list[list[tuple[int, Planned, Term]]] = []
    for time, name, hand, thing, number in answer.of("does"):
        assert isinstance(time, int) and isinstance(number, int)
        place = brought.get((time, thing))
        step = Planned(
            by_name[str(name)].steps[number].step.action, str(hand), str(thing), str(name), number,
            _spot(place), place.support if place else "",
        )  # fmt: skip
        row = (time, step, place.term if place else "any")
        last = rows[-1][-1][1] if rows else None
        same = last and (last.recording, last.hand, last.thing) == (
            str(name),
            str(hand),
            str(thing),
        )
        if last and same and last.number + 1 == number:
            rows[-1].append(row)
        else:
            rows.append([row])
    return tuple(
        Stage(
            by_name[row[0][1].recording],
            tuple(step for _, step, _ in row),
            next((term for _, _, term in reversed(row) if term != "any"), "any"),
            frozenset((str(h), str(t)) for at, h, t in answer.of("touch") if at == row[-1][0]),
        )
        for row in rows
    )


def _spot(place: Place | None) -> Spot | None:
    if place is None:
        return None
    x, y, z = (float(value) for value in place.pose.translation)
    return x, y, z
