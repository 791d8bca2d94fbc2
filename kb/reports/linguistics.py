"""The linguistic report: verb classes with status and evidence, senses, claims, coverage."""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import TypeAlias

from kb.lexicon.english import words_of
from kb.lexicon.links import (
    PrimitiveWords,
    Remark,
    SenseLink,
    ThesisClaim,
    ThesisStatus,
    above,
    book_order,
    levin_classes,
    motion_senses,
    remarks,
    sense_links,
    thesis_claims,
    thesis_senses,
)
from kb.lexicon.verbs import Seen, doubts_of, total
from kb.lexicon.wordnet import Synset, table, wordnet

Row: TypeAlias = tuple[str, ...]
"""The arguments of an atom that the lexical rules derived."""


class Status(StrEnum):
    """Whether the system addresses a class now, as the rules derive it."""

    ADDRESSED = "addressed"
    PARTLY = "partly"
    NOT = "not_addressed"

    @property
    def words(self) -> str:
        """The status as people read it."""
        return "in part" if self is Status.PARTLY else self.value.replace("_", " ")


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
    """Those that address it, or what is more general, sorted."""

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
    def reason(self) -> str:
        """Why the status is what it is, in a sentence."""
        gone = [each for each in self.judged if each.how is not How.ADDRESSED]
        if not gone:
            doers = sorted({name for each in self.judged for name in each.primitives})
            return f"By {', '.join(doers)}."
        told = []
        for each in gone:
            by = ", ".join(each.primitives)
            how = {
                How.GENERAL: f"not addressed; only what is more general is: {by}",
                How.PURPOSE: f"only as a purpose that the user states, of {by}",
            }.get(each.how, "not addressed")
            lacks = f" Missing: {'; '.join(each.lacks)}." if each.lacks else ""
            told.append(f"{each.verb}: {how}.{lacks}")
        return " ".join(told)


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


def assemble(
    derived: Mapping[str, Sequence[Row]],
    words: Sequence[PrimitiveWords],
    seen: Sequence[Seen],
    members: Mapping[str, frozenset[str]],
) -> LinguisticReport:
    """The report over what was derived, the primitives' words, and what was observed."""
    parts = _Parts(derived, words, seen, members)
    numbers = sorted(parts.status, key=book_order)
    classes = tuple(parts.class_report(number) for number in numbers)
    senses = []
    for link in (*thesis_senses(), *(s for word in sorted(words) for s in sense_links(word))):
        synset = wordnet().of_key(link.key) if link.key in wordnet() else None
        ranks = {sense.key: sense.number for sense in synset.senses} if synset else {}
        senses.append(SenseRow(link, synset, ranks.get(link.key, 0)))
    verbs = [each for report in classes for each in report.verbs]
    return LinguisticReport(
        classes=classes,
        claims=thesis_claims(),
        senses=tuple(senses),
        primitives=tuple(sorted(words)),
        remarks=remarks(),
        coverage=Coverage(
            classes=len(classes),
            classes_addressed=sum(each.status is Status.ADDRESSED for each in classes),
            classes_partly=sum(each.status is Status.PARTLY for each in classes),
            verbs=len(verbs),
            verbs_addressed=sum(verb.how is How.ADDRESSED for verb in verbs),
            verbs_general=sum(verb.how is How.GENERAL for verb in verbs),
            verbs_purpose=sum(verb.how is How.PURPOSE for verb in verbs),
            segments=total(seen),
            segments_named=total(each for each in seen if each.primitive),
            segments_in_classes=total({e for number in numbers for e in parts.showing(number)}),
            unstated=len(unstated_classes()),
        ),
        observations=tuple(sorted({each.observation for each in seen})),
        verbnet=bool(members),
        doubts=doubts_of(sorted(words)),
    )


class _Parts:
    def __init__(
        self,
        derived: Mapping[str, Sequence[Row]],
        words: Sequence[PrimitiveWords],
        seen: Sequence[Seen],
        members: Mapping[str, frozenset[str]],
    ) -> None:
        def last_by(predicate: str) -> dict[Row, tuple[str, ...]]:
            """Last arguments by those before, sorted."""
            return _grouped((row[:-1], row[-1]) for row in derived.get(predicate, ()))

        self.status = {row[0]: Status(row[1]) for row in derived.get("status", ())}
        self.counts = last_by("counts")
        self.linked = _grouped(((row[1],), row[0]) for row in derived.get("linked", ()))
        self.how = {
            How.ADDRESSED: last_by("addressed"),
            How.GENERAL: last_by("only_general"),
            How.PURPOSE: last_by("only_purpose"),
        }
        self.missing = last_by("missing")
        self.own = {(number, name) for number, _, name in derived.get("addressed", ())}
        self.purposes = set(derived.get("only_purpose", ()))
        self.proofs = defaultdict(list)
        for number, primitive, kind, where in derived.get("proof", ()):
            self.proofs[number].append(Proof(primitive, kind, where))
        self.words = {word.name: word for word in words}
        self.files = {word.name: word.file for word in words if word.file}
        self.seen = seen
        self.members = members

    def showing(self, number: str) -> tuple[Seen, ...]:
        """What was seen of a class: its verbs' own primitives, and what was stated to be done."""
        return tuple(
            each
            for each in self.seen
            if (number, each.primitive) in self.own
            or (number, words_of(each.purpose), each.primitive) in self.purposes
        )

    def class_report(self, number: str) -> ClassReport:
        levin = levin_classes()[number]
        judged = set(self.counts.get((number,), ()))
        verbs = sorted(judged | set(self.members.get(number, ())))
        reports = tuple(self._verb(number, verb, counts=verb in judged) for verb in verbs)
        doers = sorted({name for each in reports if each.counts for name in each.primitives})
        showing = self.showing(number)
        observed = {(each.primitive, "observed", each.observation) for each in showing}
        return ClassReport(
            number=number,
            title=levin.title,
            size=levin.size,
            status=self.status[number],
            claims=tuple(each for each in thesis_claims() if each.levin == number),
            verbs=reports,
            primitives=self.linked.get((number,), ()),
            files=tuple(sorted({self.files[each] for each in doers if each in self.files})),
            # Without those by what is only more general.
            proofs=tuple(
                each
                for each in self.proofs[number]
                if (number, each.primitive) in self.own
                or (each.primitive, each.kind, each.where) in observed
            ),
            remarks=tuple(
                each
                for each in remarks()
                if each.levin == number
                or (each.levin in levin_classes() and number in above(each.levin))
            ),
            segments=total(showing),
        )

    def _verb(self, number: str, verb: str, *, counts: bool) -> VerbReport:
        key = (number, verb)
        how = next((each for each, found in self.how.items() if key in found), How.MISSING)
        primitives = self.how[how][key] if how in self.how else ()
        own = primitives if how is How.ADDRESSED else ()
        segments = total(each for each in self.seen if each.primitive in own)
        tested = (each for each in self.proofs.get(number, ()) if each.kind == "tested")
        cases = tuple(sorted({each.where for each in tested if each.primitive in own}))
        said = {
            row["need"]: row["words"]
            for row in table("needs")
            if row["class"] == number and row["verb"] == verb
        }
        # The senses that the primitives have the verb in; without any, those as a motion.
        links = (link for name in own for link in sense_links(self.words[name]))
        keys = dict.fromkeys(link.key for link in links if link.verb == verb)
        senses = tuple(
            wordnet().of_key(each) for each in keys or motion_senses(verb) if each in wordnet()
        )
        evidence = Evidence.NONE
        if own:
            unseen = Evidence.TESTED if cases else Evidence.RULE
            evidence = Evidence.OBSERVED if segments else unseen
        return VerbReport(
            verb=verb,
            how=how,
            primitives=primitives,
            lacks=tuple(
                said.get(each, "a primitive of this class with this verb")
                for each in self.missing.get(key, ())
            ),
            senses=senses or tuple(synset for _, synset in wordnet().of_lemma(verb)[:1]),
            counts=counts,
            evidence=evidence,
            segments=segments,
            cases=cases,
        )


def _grouped(pairs: Iterable[tuple[Row, str]]) -> dict[Row, tuple[str, ...]]:
    found: dict[Row, set[str]] = defaultdict(set)
    for key, value in pairs:
        found[key].add(value)
    return {key: tuple(sorted(each)) for key, each in found.items()}


def unstated_classes() -> tuple[str, ...]:
    """Classes of which the thesis's classification says nothing, in the book's order.

    What it denies of a whole class it denies of the class's parts; what it claims for a verb it
    claims for the verb's own class alone (thesis 6.1).
    """
    stated = {claim.levin for claim in thesis_claims() if claim.levin and claim.section == "6.1"}
    denied = {claim.levin for claim in thesis_claims() if claim.status is ThesisStatus.NOT}
    return tuple(
        each.number
        for each in levin_classes().values()
        if each.size and each.number not in stated and denied.isdisjoint(above(each.number))
    )
