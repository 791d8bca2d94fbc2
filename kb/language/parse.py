"""English in: an instruction to be done, several of them, or a question to be asked."""

from kb.language.instruction import Instruction, Plan
from kb.language.question import Question
from kb.language.reading.questions import question
from kb.language.reading.reader import Reader
from kb.language.reading.statements import statements
from kb.language.reading.verb_entries import VerbEntries
from kb.language.tokens import Cursor
from kb.language.vocabulary import Vocabulary


def parse(text: str, vocabulary: Vocabulary | None = None) -> Instruction | Plan | Question:
    """Read a text.

    Raises:
        SentenceError: A word that cannot be read; it says where, and what could stand there.
    """
    words = vocabulary or Vocabulary()
    reader = Reader(Cursor(text), words, VerbEntries(words))
    cursor = reader.cursor
    if cursor.done:
        raise cursor.error("an empty sentence", reader.verbs.beginnings)
    return question(reader) or statements(reader)
