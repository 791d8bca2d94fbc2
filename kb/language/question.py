"""Questions about what was done, as SPARQL over an Actionary."""

import json
from dataclasses import dataclass
from enum import Enum
from importlib.resources import files

from kb.language.sentence import Instruction


class Ask(Enum):
    """What a question asks for; its value is the variable that answers it."""

    WHO = "performer"
    WHICH_HAND = "ee"
    WHEN = "start"
    HOW_LONG = "duration"
    WHERE_SEEN = "observation"

    @property
    def needs_did(self) -> bool:
        """Whether a helping verb and a subject follow: ``when did the agent``."""
        return self in {Ask.WHEN, Ask.HOW_LONG, Ask.WHERE_SEEN}


QUESTION_WORDS: dict[tuple[str, ...], Ask] = {
    ("who",): Ask.WHO,
    ("which", "hand"): Ask.WHICH_HAND,
    ("which", "end-effector"): Ask.WHICH_HAND,
    ("when",): Ask.WHEN,
    ("how", "long"): Ask.HOW_LONG,
    ("in", "which", "capture"): Ask.WHERE_SEEN,
}
"""Words that begin a question, and what it then asks for."""


@dataclass(frozen=True, slots=True)
class Question:
    """What is asked of every segment that an instruction fits."""

    ask: Ask
    about: Instruction

    @property
    def sparql(self) -> str:
        """The query; its first variable answers the question."""
        query = (files("kb") / "language" / "done.rq").read_text(encoding="utf-8")
        objects = (*self.about.call.objects, "", "")
        said = {
            "action": self.about.call.action,
            "performer": self.about.agent,
            "first": objects[0],
            "second": objects[1],
            "ee": self.about.ee,
            "purpose": self.about.call.purpose,
        }
        for name, value in said.items():
            if value:
                query = query.replace(f"VALUES ?{name} {{ UNDEF }}", _values(name, value))
        others = [each for each in _SHOWN if each != self.ask.value]
        return query.replace("?answers", " ".join(f"?{each}" for each in (self.ask.value, *others)))


_SHOWN = ("observation", "performer", "ee", "start", "end", "duration")


def _values(name: str, value: str) -> str:
    return f"VALUES ?{name} {{ {json.dumps(value, ensure_ascii=False)} }}"
