"""A cursor over a sentence with the words that can be read and what was spoken of before."""

from dataclasses import dataclass

from kb.language.reading.function_words import is_manner, of_class, prepositions
from kb.language.reading.verb_entries import VerbEntries
from kb.language.tokens import Cursor
from kb.language.vocabulary import Vocabulary
from kb.lexicon.english import Form

STOPS = (
    *("determiner", "person", "pronoun", "auxiliary", "negation", "particle", "manner"),
    *("relation", "count", "preposition"),
)
"""Classes of words that no name of an object goes on with."""

CONNECTIVES = frozenset({",", ".", ";", ":", "(", ")", "and", "or", "but", "then", "to", ""})
RELATIVES = frozenset({"who", "that", "which", "what", "where", "whose", "whom"})


@dataclass
class Reader:
    """What is read, by what, and what was spoken of before."""

    cursor: Cursor
    words: Vocabulary
    verbs: VerbEntries
    thing: str = ""
    """What ``it`` is."""

    several: tuple[str, ...] = ()
    """What ``them`` are."""

    taken: tuple[str, str] = ("", "")
    """What was handled last, and with which hand."""

    place: str = ""
    """Where ``there`` is."""

    limb: str = ""
    agent: str = ""
    gap: bool = False
    """Whether a preposition may stand without its object: ``what did she look at``."""

    limit: int = 1_000_000
    """The word at which a name ends at the latest."""

    literals: frozenset[str] = frozenset()
    """Words that belong to the verb that is being read: ``go`` of ``let go``."""

    def stops(self, ahead: int = 0) -> bool:
        """Whether the next word cannot be a part of a name."""
        cursor = self.cursor
        word = cursor.peek(ahead)
        if cursor.at + ahead >= self.limit:
            return True
        if word in CONNECTIVES or word in RELATIVES or word.startswith('"') or is_manner(word):
            return True
        start = cursor.at
        cursor.at += ahead
        found = any(cursor.longest(of_class(each)) is not None for each in STOPS)
        cursor.at = start + ahead
        found = found or cursor.longest(prepositions()) is not None
        cursor.at = start
        return found

    def verb_forms(self, ahead: int = 0) -> frozenset[Form]:
        """The forms of verbs that the next word may be."""
        return frozenset(form for _, form in self.verbs.lemmas(self.cursor.peek(ahead)))

    def verb_ahead(self) -> bool:
        """Whether the next word is a form of a verb that primitives are said with."""
        found = self.verbs.lemmas(self.cursor.peek())
        return any(lemma in self.verbs.ways for lemma, _ in found)

    def finite_ahead(self) -> bool:
        """Whether a verb of a sentence with a subject comes next, after adverbs."""
        ahead = 0
        while is_manner(self.cursor.peek(ahead)) or self.cursor.peek(ahead) in {"then", "never"}:
            ahead += 1
        if self.cursor.peek(ahead) in {word[0] for word in of_class("auxiliary")}:
            return True
        return bool(self.verb_forms(ahead) & {Form.BASE, Form.PAST, Form.THIRD})
