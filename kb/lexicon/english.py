"""English words: past tenses, nouns, lists and numbers, and inflected verbs read back."""

import re
from collections.abc import Callable, Iterator, Sequence
from enum import StrEnum
from functools import cache

from kb.lexicon.wordnet import table

PEOPLE = frozenset(
    (
        *("actor", "actress", "adult", "agent", "assistant", "athlete", "baby", "boy", "chef"),
        *("child", "cook", "customer", "dancer", "demonstrator", "doctor", "elder", "expert"),
        *("father", "female", "friend", "gentleman", "girl", "giver", "guest", "helper", "host"),
        *("human", "individual", "infant", "instructor", "kid", "lady", "male", "man", "mother"),
        *("musician", "neighbour", "novice", "nurse", "operator", "parent", "participant"),
        *("partner", "patient", "performer", "person", "player", "pupil", "receiver", "robot"),
        *("singer", "student", "subject", "taker", "teacher", "teenager", "therapist", "toddler"),
        *("trainer", "user", "visitor", "volunteer", "waiter", "waitress", "woman", "worker"),
    )
)
"""Common nouns for whoever may perform."""

_CAMEL = re.compile(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])|\d+")


@cache
def _past_forms() -> dict[str, str]:
    return {row["verb"]: row["past"] for row in table("past_forms")}


def past(verb: str) -> str:
    """The simple past of a verb, of which the first word is inflected: ``let go``."""
    head, _, rest = verb.partition(" ")
    regular = f"{head}ed"
    if head.endswith("e"):
        regular = f"{head}d"
    elif head.endswith("y") and head[-2:-1] not in "aeiou":
        regular = f"{head[:-1]}ied"
    form = _past_forms().get(head, regular)
    return f"{form} {rest}" if rest else form


def noun(name: str) -> str:
    """A name as people say it: ``blue_cup`` as ``blue cup``."""
    return " ".join(name.split("_")).strip() or name


def the(name: str) -> str:
    """A name as a definite noun phrase; a proper name stays alone, and so does a numbered one."""
    spoken = noun(name)
    *named, last = spoken.split(" ")
    alone = spoken[:1].isupper() or (named and last.isdigit())
    return spoken if alone else f"the {spoken}"


def the_agent(name: str, kind: str = "") -> str:
    """Who acts: ``the tall man``, but ``Anna``; a name with a number stands alone as it is.

    A name whose last word is the agent's kind, or a common noun for people, is no proper name.
    """
    words = noun(name).split()
    if any(each.isdigit() for each in name):
        return noun(name)
    if not words or words[-1] in {*PEOPLE, *noun(kind).split()[-1:]}:
        return the(name)
    return " ".join(map(capital, words))


def words_of(name: str) -> str:
    """A name in mixed case as words: ``PickUp`` as ``pick up``."""
    return " ".join(part.lower() for part in _CAMEL.findall(name))


def name_of(words: str) -> str:
    """Words as a name in mixed case: ``pick up`` as ``PickUp``."""
    return "".join(word[:1].upper() + word[1:] for word in words.split())


def joined(parts: Sequence[str]) -> str:
    """Parts as a list in a sentence: ``a, b, and c``."""
    if len(parts) == 2 and ", " in parts[0]:
        return f"{parts[0]}, and {parts[1]}"
    if len(parts) <= 2:
        return " and ".join(parts)
    return f"{', '.join(parts[:-1])}, and {parts[-1]}"


def capital(text: str) -> str:
    """The text with a capital at its beginning."""
    return text[:1].upper() + text[1:]


_SMALL = (
    *("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten"),
    *("eleven", "twelve", "thirteen", "fourteen", "fifteen", "sixteen", "seventeen"),
    *("eighteen", "nineteen"),
)
_TENS = ("twenty", "thirty", "forty", "fifty", "sixty", "seventy", "eighty", "ninety")


def number(count: int) -> str:
    """A number in words below a hundred, else in figures: ``twenty-one``."""
    if count < len(_SMALL):
        return _SMALL[count]
    if count >= 100:
        return str(count)
    tens, ones = divmod(count, 10)
    return _TENS[tens - 2] + (f"-{_SMALL[ones]}" if ones else "")


_FIRST = (
    *("first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth", "ninth"),
    *("tenth", "eleventh", "twelfth"),
)


def ordinal(count: int) -> str:
    """Which of several in words up to twelve, else in figures: ``second``, ``13th``, ``21st``."""
    if count <= len(_FIRST):
        return _FIRST[count - 1]
    ending = "th" if count % 100 in {11, 12, 13} else {1: "st", 2: "nd", 3: "rd"}.get(count % 10)
    return f"{count}{ending or 'th'}"


def times(count: int) -> str:
    """How often: ``twice``, ``three times``."""
    return {1: "once", 2: "twice"}.get(count, f"{number(count)} times")


class Form(StrEnum):
    """A form of a verb."""

    BASE = "base"
    THIRD = "third person"
    PAST = "past"
    PARTICIPLE = "participle"
    GERUND = "gerund"


def lemmas(word: str, known: Callable[[str], bool]) -> tuple[tuple[str, Form], ...]:
    """The verbs that a word may be a form of, each with the form.

    Args:
        word: In lower case.
        known: Whether there is a verb.
    """
    found = [(word, Form.BASE)]
    for row in table("past_forms"):
        found += [(row["verb"], Form.PAST)] if row["past"] == word else []
        found += [(row["verb"], Form.PARTICIPLE)] if row["participle"] == word else []
    if word.endswith("ing"):
        found += ((each, Form.GERUND) for each in _stems(word[:-3]))
    if word.endswith("ed"):
        for form in (Form.PAST, Form.PARTICIPLE):
            found += ((each, form) for each in _stems(word[:-2]))
    if word.endswith("s"):
        stems = (word[:-1], word[:-2] if word.endswith("es") else "")
        found += ((each, Form.THIRD) for each in stems if each)
        if word.endswith("ies"):
            found.append((f"{word[:-3]}y", Form.THIRD))
    return tuple(dict.fromkeys(each for each in found if known(each[0])))


def _stems(stem: str) -> Iterator[str]:
    yield stem
    yield f"{stem}e"
    if stem[-1:] == stem[-2:-1]:
        yield stem[:-1]
    if stem.endswith("i"):
        yield f"{stem[:-1]}y"
