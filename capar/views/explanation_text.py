"""Explanations as lines of text: the summary, the table of conditions, the tree of reasons."""

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from capar.model.body_names import body_names
from capar.model.notices import KINDS, Notice
from capar.model.observation import JointAction, Observation, Segment, SegmentAddress
from capar.views.movers import joined, mover_lines
from capar.views.notices import reservations
from capar.views.picture import MOST_NAMED, spoken
from capar_rules.explain.conditions import Condition
from capar_rules.explain.explanation import Explanation, Reason
from capar_rules.explain.sentences import parsed

JOINT, LOOKS, LOOK = "joins_in(", "looks(", "looking_at("
"""How the atoms of joint actions, of when an object was looked at, and of measured looks begin."""

FIRST_NAMED = 2
"""So many are named of more than ``MOST_NAMED`` who act together [1]."""

MOST_JOINT = 2
"""So many joint actions of one name are listed one by one [1]."""

ABOVE, ALSO_ABOVE = "see above", "see also above"
"""What a line has in place of all, or of some, of the lines below it, which stand above."""


def explanation_lines(
    told: Explanation, seen: Observation, definitions: Mapping[str, str] | None = None
) -> Iterator[str]:
    """What an explanation says.

    Args:
        told: The explanation.
        seen: The observation that it is of.
        definitions: What names are, by name; without them only the summary is given.
    """
    yield header(told)
    yield told.summary
    staying = {
        parsed(node.atom)[1][0] for node in told.reason.walk() if node.atom.startswith("stays(")
    }
    yield from mover_lines(seen, told.ee, told.index, staying=staying)
    if definitions is None:
        return
    yield from condition_table(told.conditions)
    if told.nearest is not None:
        yield f"{told.nearest.name} would need:"
        yield from condition_table(told.nearest.failing)
    yield from told.notes
    yield from (f"{name}: {definition}" for name, definition in definitions.items())
    yield from _branch(reason_tree(told, seen), 0)


def header(segment: Segment | Explanation) -> str:
    """Which segment it is, or is explained, and from when to when."""
    span = f"{segment.start_s:.2f} to {segment.end_s:.2f} s"
    return f"{SegmentAddress(segment.ee, segment.index)}  {span}"


def condition_table(conditions: Sequence[Condition]) -> Iterator[str]:
    """Conditions, and below each the quantities that it compares, with value and limit."""
    rows = [
        (condition.sentence, one.label, one.value_text, one.limit_text)
        for condition in conditions
        for one in condition.measures
    ]
    widths = [max((len(row[column]) for row in rows), default=0) for column in (1, 2)]
    for condition in conditions:
        if condition.sentence:
            yield f"  {condition.sentence}"
        for one in condition.measures:
            value = f"{one.label:<{widths[0]}}  {one.value_text:>{widths[1]}}"
            yield f"      {value}  {one.limit_text}".rstrip()


def notices_about(
    segments: Sequence[Segment], seen: Observation, told: Sequence[Explanation] = ()
) -> tuple[Notice, ...]:
    """The notices that affect segments, and all that explanations measure."""
    about = {name for segment in segments for name in (segment.ee, *segment.objects)}
    conditions = [one for each in told for one in each.conditions]
    about |= {body for one in conditions for each in one.measures for body in each.bodies}
    return tuple(
        notice
        for notice in reservations(seen.notices, about=about)
        if not KINDS[notice.code].of_pair or about >= {*notice.bodies}
    )


def reason_tree(told: Explanation, seen: Observation) -> Reason:
    """The sentences of an explanation, each where it is met first.

    A segment is said to be part of the joint actions that were observed, and not once for each
    other end-effector that takes part. When it was looked at is said by measured looks alone.
    """
    top = told.reason
    below = []
    for cause in top.because:
        if cause.atom.startswith(LOOKS):
            looks = tuple(each for each in cause.because if each.atom.startswith(LOOK))
            below += [replace(cause, because=looks)] if looks else []
        elif not cause.atom.startswith(JOINT):
            below.append(cause)
    below += _joint(told, seen)
    return replace(top, because=tuple(below)).sentences_once()


def _branch(reason: Reason, depth: int) -> Iterator[str]:
    frames = f"  [frames {reason.frames[0]} to {reason.frames[1]}]" if reason.frames else ""
    above = (ALSO_ABOVE if reason.because else ABOVE) if reason.repeated else ""
    noted = "; ".join(filter(None, (reason.rule, above)))
    yield f"{'  ' * depth}- {reason.sentence}{frames}{f'  ({noted})' if noted else ''}"
    for below in reason.because:
        yield from _branch(below, depth + 1)


def _joint(told: Explanation, seen: Observation) -> Iterator[Reason]:
    """The joint actions that a segment is part of; of many of one name the longest."""
    named: dict[str, list[JointAction]] = defaultdict(list)
    for joint in seen.joint:
        if (told.ee, told.index) in zip(joint.ees, joint.segments, strict=True):
            named[joint.name].append(joint)
    for group in named.values():
        if len(group) <= MOST_JOINT:
            for joint in group:
                yield _stated(f"it is part of one action of {_who(joint, seen)}", joint)
            continue
        longest = max(group, key=lambda joint: joint.last - joint.first)
        counts = sorted({len(joint.who) for joint in group})
        of = f"{counts[0]} to {counts[-1]}" if len(counts) > 1 else f"{counts[0]}"
        many = f"it is part of {len(group)} actions of {of} end-effectors each"
        yield _stated(f"{many}; the longest, of {_who(longest, seen)}", longest)


def _stated(sentence: str, joint: JointAction) -> Reason:
    """What is said of a joint action, and from when to when all who take part do it."""
    span = f"from {joint.start_s:.2f} s to {joint.end_s:.2f} s"
    text = f"{sentence}: {joint.name}, {span}"
    return Reason(text, "", "", (joint.first, joint.last), False, ())


def _who(joint: JointAction, seen: Observation) -> str:
    """Who takes part, as the other sentences call them; of many the first two are named."""
    both, called = seen.who(joint), body_names(seen)
    if both.startswith("both "):
        return both
    names = [f"the {called.get(ee, spoken(ee))}" for ee in joint.who]
    left = len(names) - FIRST_NAMED
    return joined([*names[:FIRST_NAMED], f"{left} more"] if len(names) > MOST_NAMED else names)
