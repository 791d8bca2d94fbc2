"""A step as one sentence that `parse` reads back: ``Move the mug to the head with ...``."""

import json
import re

from capar.model.observation import Segment
from capar.model.par import Call, Step
from kb.language.instruction import Instruction
from kb.language.vocabulary import EVERYTHING, Vocabulary
from kb.lexicon.english import capital, name_of, the, words_of

_PLAIN = re.compile(r"[A-Za-z][A-Za-z0-9_]*")


def sentence(value: Instruction | Step | Segment, vocabulary: Vocabulary | None = None) -> str:
    """The sentence that says an instruction, and nothing else does."""
    words = vocabulary or Vocabulary()
    told = value if isinstance(value, Instruction) else Instruction.of(value)
    parts = [_core(told.call, words)]
    if told.source:
        parts.append(f"from {the(told.source)}")
    if told.ee:
        parts.append(f"with {EVERYTHING if told.ee == 'all' else the(told.ee)}")
    if told.call.purpose:
        parts.append(_purpose(told.call.purpose))
    text = " ".join(parts)
    return f"{the(told.agent)}, {text}." if told.agent else f"{capital(text)}."


def _core(call: Call, words: Vocabulary) -> str:
    usual = words.canonical.get((call.action, len(call.objects)))
    if usual is None:
        name = call.action if _PLAIN.fullmatch(call.action) else json.dumps(call.action)
        things = " and ".join(the(each) for each in call.objects)
        return f"perform {name} on {things}" if things else f"perform {name}"
    text = usual.pattern
    for number, name in enumerate(call.objects, 1):
        text = text.replace(f"{{{number}}}", the(name))
    return text


def _purpose(purpose: str) -> str:
    """The end: ``to pick up`` where the words give the name back, else the name in quotes."""
    words = words_of(purpose)
    plain = words and name_of(words) == purpose and words.replace(" ", "").isalpha()
    return f"to {words}" if plain else f"for {json.dumps(purpose)}"
