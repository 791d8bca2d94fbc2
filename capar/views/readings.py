"""What was read out of a sentence, and what answers it, as lines of text for people."""

import math
from collections.abc import Iterator, Mapping, Sequence

from kb.language import Condition, Instruction, Plan, Question
from kb.language.question import Ask

Row = Mapping[str, object]


def reading_lines(value: Instruction | Plan) -> tuple[str, ...]:
    """An instruction field by field; of several, a line for each, in their order."""
    if isinstance(value, Instruction):
        return tuple(f"{name:<9}{text}" for name, text in _fields(value))
    lines: list[str] = []
    for index, part in enumerate(value.parts):
        for beside, stream in enumerate(part):
            first = "meanwhile" if beside else ("then" if index else "")
            for step in stream:
                lines.append(f"{len(lines) + 1:>2}. {first + ' ' if first else ''}{phrase(step)}")
                first = "meanwhile then" if beside else "then"
    return tuple(lines)


def question_lines(value: Question) -> tuple[str, ...]:
    """What a question asks for, and of what."""
    rank = f"{value.rank} " if value.rank else ""
    lines = [f"asks for {rank}{value.ask.value}", f"of       {phrase(value.about)}"]
    lines += [f"or       {phrase(each)}" for each in value.alternatives]
    lines += [f"and      {phrase(each)}" for each in value.also]
    return tuple(lines)


def answer_lines(value: Question, about: Instruction, rows: Sequence[Row]) -> tuple[str, ...]:
    """The answers to a question, one a line."""
    told = [_row(each) for each in rows]
    if value.ask is Ask.WHETHER:
        return (f"Yes: {phrase(about)}.", *told) if rows else (f"No: {_nowhere(about)}",)
    return tuple(told) or (_nowhere(about),)


def _nowhere(about: Instruction) -> str:
    for each in (about, *(condition.about for condition in about.circumstances.conditions)):
        if not each.known and each.said and each.said != "be":
            return f"no primitive has the verb {each.said!r}, so that nothing is known of it."
    return "nothing like it stands in any observation."


def _row(row: Row) -> str:
    return "  ".join(f"{name}: {_short(each)}" for name, each in row.items() if each is not None)


def _short(value: object) -> object:
    """A number to milliseconds, for people."""
    return round(value, 3) if isinstance(value, float) else value


def phrase(value: Instruction) -> str:
    """An instruction in one line: ``MoveObjTo(mug, box) with the right hand``."""
    objects = ", ".join(each or "_" for each in value.call.objects)
    rest = [f"{name} {text}" for name, text in _fields(value) if name not in {"action", "objects"}]
    tail = f"; {'; '.join(rest)}" if rest else ""
    return f"{value.call.action or 'anything'}({objects}){tail}"


def _fields(value: Instruction) -> Iterator[tuple[str, str]]:
    own = value.circumstances
    note = "" if value.known or value.said == "be" else " (no primitive has this verb)"
    yield "action", f"{value.call.action or 'any'}{note}"
    yield "objects", ", ".join(each or "any" for each in value.call.objects) or "none"
    if own.negated:
        yield "not", "to be done"
    said = {
        "verb": "" if value.said in {"", "be"} else value.said,
        "agent": value.agent,
        "ee": value.ee,
        "from": value.source,
        "purpose": value.call.purpose,
        "also": ", ".join(own.others),
        "where": ", ".join(f"{word} {place}" for word, place in own.places),
        "how": ", ".join(own.manner),
        "times": str(own.count) if own.count else "",
        "for": f"{own.duration_s:g} s" if own.duration_s else "",
        "within": _window(own.window),
    }
    yield from ((name, text) for name, text in said.items() if text)
    yield from (_condition(each) for each in own.conditions)


def _window(window: tuple[float, float] | None) -> str:
    if window is None:
        return ""
    first, last = window
    if first < 0:
        return f"the last {-first:g} s"
    if first == last:
        return f"{first:g} s"
    return f"{first:g} s to the end" if math.isinf(last) else f"{first:g} to {last:g} s"


def _condition(condition: Condition) -> tuple[str, str]:
    return condition.relation.value, f"[{phrase(condition.about)}]"
