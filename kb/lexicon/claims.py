"""What rule files state of words, compared with WordNet's verbs and Levin's classes."""

from collections.abc import Iterable, Iterator, Sequence
from difflib import get_close_matches

from kb.lexicon.levin import levin_classes as known_classes
from kb.lexicon.links import PrimitiveWords, sense_key
from kb.lexicon.wordnet import wordnet

MOST = 5
"""How many names near a wrong one are listed."""


def doubts(verb: str, levin_classes: Sequence[str], senses: Sequence[str]) -> tuple[str, ...]:
    """What is stated of a verb and not known here, in a clause each, with what is near it.

    Args:
        verb: As people write it; may be empty.
        levin_classes: Numbers of Levin's classes.
        senses: Numbers of the verb's senses in WordNet 3.1, or sense keys.
    """
    return tuple(_doubts(verb, levin_classes, senses))


def doubts_of(words: Iterable[PrimitiveWords]) -> tuple[str, ...]:
    """The doubts about what the rule files of primitives state, each with file and primitive."""
    return tuple(
        f"{each.file}: {each.name}: {doubt}"
        for each in words
        for index, verb in enumerate(each.verbs or ("",))
        for doubt in (doubts(verb, (), ()) if index else doubts(verb, each.levin, each.senses))
    )


def nearest_verbs(verb: str) -> tuple[str, ...]:
    """The verbs of WordNet that are written most like one that it lacks."""
    word = verb.strip().lower().replace(" ", "_")
    close = get_close_matches(word, wordnet().lemmas, n=MOST)
    return tuple(each.replace("_", " ") for each in close)


def the_nearest(names: Sequence[str]) -> str:
    """A clause that goes on from a name that there is not, with those near it."""
    if not names:
        return ", nor one near it"
    return f"; the nearest {'are' if len(names) > 1 else 'is'} {', '.join(names)}"


def _doubts(verb: str, classes: Sequence[str], senses: Sequence[str]) -> Iterator[str]:
    known = wordnet().of_lemma(verb)
    if verb and not known:
        yield f"WordNet has no verb {verb!r}{the_nearest(nearest_verbs(verb))}"
    for number in classes:
        if number not in known_classes():
            close = get_close_matches(number, known_classes(), n=MOST)
            yield f"Levin has no class {number!r}{the_nearest(close)}"
    for each in senses:
        if sense_key(verb, each) in wordnet():
            continue
        if each.isdigit():
            has = f"; it has 1 to {len(known)}" if known else ""
            yield f"WordNet has no sense {each} of {verb!r}{has}"
        else:
            close = get_close_matches(each, [sense.key for sense, _ in known], n=MOST)
            yield f"WordNet has no verb sense {each!r}{the_nearest(close)}"
