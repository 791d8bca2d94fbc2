"""Clauses put together as one, and parts as lists in words."""

from collections.abc import Sequence

START, END, BOTH = " at the start", " at the end", " and at the end"


def joined_sides(begin: str, parts: Sequence[str]) -> str:
    """Clauses that begin alike and differ in the side, and in numbers of it, as one."""
    brackets = {part[part.rindex(" (") :] for part in parts} if len(parts) > 1 else set[str]()
    if len(brackets) == 1:
        (bracket,) = brackets
        parts = [*(part.removesuffix(bracket) for part in parts[:-1]), parts[-1]]
    text = " and ".join([parts[0], *(part.removeprefix(begin) for part in parts[1:])])
    return text.replace(" and  at ", " and at ")


def at_both(clauses: Sequence[str]) -> list[str]:
    """The clauses, of which two that differ only in the side are one."""
    ends = {clause.removesuffix(END) for clause in clauses if clause.endswith(END)}
    starts = {clause.removesuffix(START) for clause in clauses if clause.endswith(START)}
    both = ends & starts
    return [
        clause + BOTH if clause.removesuffix(START) in both else clause
        for clause in clauses
        if clause.removesuffix(END) not in both
    ]


def listed(parts: Sequence[str], word: str = "and") -> str:
    """Parts as a list in words."""
    if len(parts) < 2:
        return "".join(parts) or "the rules say so"
    comma = "," * (len(parts) > 2 or any("," in part for part in parts))
    return f"{', '.join(parts[:-1])}{comma} {word} {parts[-1]}"
