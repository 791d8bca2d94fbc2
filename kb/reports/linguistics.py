"""The linguistic report as values: classes, senses, statuses with their evidence, coverage."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

from kb.lexicon.links import PrimitiveWords, Remark, SenseLink, ThesisClaim, ThesisStatus
from kb.lexicon.wordnet import Synset


class Status(StrEnum):
    """Whether the system addresses a class now, as the rules derive it."""

    ADDRESSED = "addressed"
    PARTLY = "partly"
    NOT = "not_addressed"

    @property
    def words(self) -> str:
        """The status as people read it."""
        return {"addressed": "addressed", "partly": "in part", "not_addressed": "not addressed"}[
            self.value
        ]


class How(StrEnum):
    """How the system stands to one verb."""

    ADDRESSED = "addressed"
    GENERAL = "general"
    """Not itself: only a more general primitive is seen, without the verb's own manner."""

    PURPOSE = "purpose"
    """Only as a purpose that the user states."""

    MISSING = "missing"

    @property
    def words(self) -> str:
        """The standing as people read it."""
        return {
            "addressed": "addressed",
            "general": "not addressed, only what is more general",
            "purpose": "only as a stated purpose",
            "missing": "not addressed",
        }[self.value]


class Evidence(StrEnum):
    """What shows that a verb is addressed."""

    OBSERVED = "observed"
    TESTED = "tested"
    RULE = "by rule only"
    NONE = ""


@dataclass(frozen=True, slots=True)
class VerbReport:
    """A verb of a class."""

    verb: str
    how: How
    primitives: tuple[str, ...]
    """Those that address it, or tell it in general, sorted."""

    lacks: tuple[str, ...]
    """What it would take, in words; empty if it is addressed."""

    senses: tuple[Synset, ...]
    """Its senses as a motion of the body, in WordNet 3.1."""

    counts: bool
    """Whether the class is judged by it: the thesis names it, or a primitive has it."""

    evidence: Evidence = Evidence.NONE
    """What shows an addressed verb; nothing for any other."""

    segments: int = 0
    """Observed segments of the primitives that address it."""

    cases: tuple[str, ...] = ()
    """Shipped test cases of the primitives that address it, sorted."""

    @property
    def standing(self) -> str:
        """How the system stands to it, with the evidence: ``addressed: tested (lifted)``."""
        if self.evidence is Evidence.OBSERVED:
            plural = "" if self.segments == 1 else "s"
            return f"{self.how.words}: observed ({self.segments} segment{plural})"
        if self.evidence is Evidence.TESTED:
            return f"{self.how.words}: tested ({self.cases[0]})"
        tail = f": {self.evidence.value}" if self.evidence else ""
        return f"{self.how.words}{tail}"


@dataclass(frozen=True, slots=True)
class Proof:
    """A stored observation or a shipped case that shows a primitive of a class."""

    primitive: str
    kind: str
    """``observed`` or ``tested``."""

    where: str


@dataclass(frozen=True, slots=True)
class ClassReport:
    """A Levin class: the thesis's claims, the system's status, and why."""

    number: str
    title: str
    size: int
    """How many verbs Levin lists; zero where subclasses do."""

    status: Status
    claims: tuple[ThesisClaim, ...]
    verbs: tuple[VerbReport, ...]
    primitives: tuple[str, ...]
    """Primitives that belong to the class."""

    files: tuple[str, ...]
    """Rule files of every primitive by which the status stands."""

    proofs: tuple[Proof, ...]
    remarks: tuple[Remark, ...]
    segments: int
    """Observed segments of primitives that have a verb of the class, or were stated to do one."""

    @property
    def thesis(self) -> tuple[ThesisStatus, ...]:
        """What the thesis says, each once; ``unstated`` if it names no verb of the class."""
        said = dict.fromkeys(claim.status for claim in self.claims)
        return tuple(said) or (ThesisStatus.UNSTATED,)

    @property
    def judged(self) -> tuple[VerbReport, ...]:
        """The verbs by which the status stands."""
        return tuple(each for each in self.verbs if each.counts)

    @property
    def addressed(self) -> int:
        """How many of the verbs are addressed."""
        return sum(each.how is How.ADDRESSED for each in self.verbs)

    @property
    def reason(self) -> str:
        """Why the status is what it is, in a sentence."""
        gone = [each for each in self.judged if each.how is not How.ADDRESSED]
        if not gone:
            return f"By {', '.join(self._doers())}."
        return " ".join(_about(each) for each in gone)

    def _doers(self) -> list[str]:
        return sorted({name for each in self.judged for name in each.primitives})


def _about(verb: VerbReport) -> str:
    by = ", ".join(verb.primitives)
    lacks = f" Missing: {'; '.join(verb.lacks)}." if verb.lacks else ""
    if verb.how is How.GENERAL:
        return f"{verb.verb}: not addressed; only what is more general is: {by}.{lacks}"
    if verb.how is How.PURPOSE:
        return f"{verb.verb}: only as a purpose that the user states, of {by}.{lacks}"
    return f"{verb.verb}: not addressed.{lacks}"


@dataclass(frozen=True, slots=True)
class SenseRow:
    """A primitive in a WordNet sense, with who says so."""

    link: SenseLink
    synset: Synset | None
    number_3_1: int
    """The sense's rank in WordNet 3.1; zero if it has no such sense."""


@dataclass(frozen=True, slots=True)
class Coverage:
    """How much of what is known is addressed."""

    classes: int
    classes_addressed: int
    classes_partly: int
    verbs: int
    verbs_addressed: int
    verbs_general: int
    """Verbs that are not addressed, though something more general is."""

    verbs_purpose: int
    segments: int
    segments_named: int
    segments_in_classes: int
    """Observed segments that count in one class at least."""

    unstated: int
    """Levin classes of which the thesis says nothing."""


@dataclass(frozen=True, slots=True)
class LinguisticReport:
    """Everything that the report shows."""

    classes: tuple[ClassReport, ...]
    claims: tuple[ThesisClaim, ...]
    """Every claim of the thesis, also those about no class."""

    senses: tuple[SenseRow, ...]
    primitives: tuple[PrimitiveWords, ...]
    remarks: tuple[Remark, ...]
    coverage: Coverage
    observations: tuple[str, ...]
    verbnet: bool
    """Whether VerbNet's members are known."""

    doubts: tuple[str, ...]
    """What rule files state of words that WordNet or Levin does not know."""


def share(part: int, whole: int) -> str:
    """A part of a whole as people read it: ``3 of 4 (75 %)``."""
    percent = f" ({round(100 * part / whole)} %)" if whole else ""
    return f"{part} of {whole}{percent}"


def named(values: Sequence[str], *, none: str = "none") -> str:
    """Values as a list, or a word for none."""
    return ", ".join(values) or none
