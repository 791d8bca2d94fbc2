"""Puts the linguistic report together from what the lexical rules derived."""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from kb.lexicon.english import words_of
from kb.lexicon.links import (
    PrimitiveWords,
    SenseLink,
    ThesisStatus,
    above,
    book_order,
    levin_class,
    levin_classes,
    motion_senses,
    remarks,
    sense_links,
    thesis_claims,
    thesis_senses,
)
from kb.lexicon.verbs import Seen, doubts_of, total
from kb.lexicon.wordnet import Synset, table, wordnet
from kb.reports.linguistics import (
    ClassReport,
    Coverage,
    Evidence,
    How,
    LinguisticReport,
    Proof,
    SenseRow,
    Status,
    VerbReport,
)

Rows = Iterable[tuple[str, ...]]


@dataclass(frozen=True)
class Derived:
    """The atoms that the lexical rules derive, by predicate."""

    rows: Mapping[str, Sequence[tuple[str, ...]]] = field(default_factory=dict)

    def of(self, predicate: str) -> Sequence[tuple[str, ...]]:
        """The arguments of every atom of a predicate, sorted."""
        return self.rows.get(predicate, ())

    def last_by(self, predicate: str) -> dict[tuple[str, ...], tuple[str, ...]]:
        """Last arguments by those before, sorted."""
        found: dict[tuple[str, ...], set[str]] = defaultdict(set)
        for row in self.of(predicate):
            found[row[:-1]].add(row[-1])
        return {key: tuple(sorted(each)) for key, each in found.items()}


def assemble(
    derived: Derived,
    words: Sequence[PrimitiveWords],
    seen: Sequence[Seen],
    members: Mapping[str, frozenset[str]],
) -> LinguisticReport:
    """The report over what was derived, the primitives' words, and what was observed."""
    parts = _Parts(derived, words, seen, members)
    numbers = sorted((row[0] for row in derived.of("status")), key=book_order)
    classes = tuple(parts.class_report(number) for number in numbers)
    return LinguisticReport(
        classes=classes,
        claims=thesis_claims(),
        senses=tuple(_senses(words)),
        primitives=tuple(sorted(words)),
        remarks=remarks(),
        coverage=_coverage(
            classes, seen, {each for number in numbers for each in parts.showing(number)}
        ),
        observations=tuple(sorted({each.observation for each in seen})),
        verbnet=bool(members),
        doubts=doubts_of(sorted(words)),
    )


class _Parts:
    def __init__(
        self,
        derived: Derived,
        words: Sequence[PrimitiveWords],
        seen: Sequence[Seen],
        members: Mapping[str, frozenset[str]],
    ) -> None:
        self.status = {row[0]: Status(row[1]) for row in derived.of("status")}
        self.counts = derived.last_by("counts")
        self.linked = _by_second(derived.of("linked"))
        self.how = {
            How.ADDRESSED: derived.last_by("addressed"),
            How.GENERAL: derived.last_by("only_general"),
            How.PURPOSE: derived.last_by("only_purpose"),
        }
        self.missing = derived.last_by("missing")
        self.own = {(number, name) for number, _, name in derived.of("addressed")}
        self.purposes = set(derived.of("only_purpose"))
        self.proofs = defaultdict(list)
        for number, primitive, kind, where in derived.of("proof"):
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

    def _proofs(self, number: str, showing: Sequence[Seen]) -> tuple[Proof, ...]:
        """The derived proofs, without those by what is only more general."""
        observed = {(each.primitive, "observed", each.observation) for each in showing}
        return tuple(
            each
            for each in self.proofs[number]
            if (number, each.primitive) in self.own
            or (each.primitive, each.kind, each.where) in observed
        )

    def class_report(self, number: str) -> ClassReport:
        levin = levin_class(number)
        judged = set(self.counts.get((number,), ()))
        verbs = sorted(judged | set(self.members.get(number, ())))
        reports = tuple(self._verb(number, verb, counts=verb in judged) for verb in verbs)
        doers = sorted({name for each in reports if each.counts for name in each.primitives})
        showing = self.showing(number)
        return ClassReport(
            number=number,
            title=levin.title,
            size=levin.size,
            status=self.status[number],
            claims=tuple(each for each in thesis_claims() if each.levin == number),
            verbs=reports,
            primitives=self.linked.get(number, ()),
            files=tuple(sorted({self.files[each] for each in doers if each in self.files})),
            proofs=self._proofs(number, showing),
            remarks=tuple(each for each in remarks() if _concerns(each.levin, number)),
            segments=total(showing),
        )

    def _verb(self, number: str, verb: str, *, counts: bool) -> VerbReport:
        key = (number, verb)
        how = next((each for each, found in self.how.items() if key in found), How.MISSING)
        primitives = self.how[how][key] if how in self.how else ()
        own = primitives if how is How.ADDRESSED else ()
        segments = total(each for each in self.seen if each.primitive in own)
        cases = self._cases(number, own)
        return VerbReport(
            verb=verb,
            how=how,
            primitives=primitives,
            lacks=_needs(number, verb, self.missing.get(key, ())),
            senses=self._senses(verb, primitives if how is How.ADDRESSED else ()),
            counts=counts,
            evidence=_evidence(own, segments, cases),
            segments=segments,
            cases=cases,
        )

    def _cases(self, number: str, primitives: Sequence[str]) -> tuple[str, ...]:
        """The shipped cases that show the primitives."""
        proofs = self.proofs.get(number, ())
        tested = (each for each in proofs if each.kind == "tested")
        return tuple(sorted({each.where for each in tested if each.primitive in primitives}))

    def _senses(self, verb: str, primitives: Sequence[str]) -> tuple[Synset, ...]:
        """The senses that the primitives have the verb in; without any, those as a motion."""
        own = (link for name in primitives for link in sense_links(self.words[name]))
        keys = dict.fromkeys(link.key for link in own if link.verb == verb)
        found = tuple(
            wordnet().of_key(each) for each in keys or motion_senses(verb) if each in wordnet()
        )
        return found or tuple(synset for _, synset in wordnet().of_lemma(verb)[:1])


def _evidence(primitives: Sequence[str], segments: int, cases: Sequence[str]) -> Evidence:
    """The strongest evidence of an addressed verb."""
    if not primitives:
        return Evidence.NONE
    if segments:
        return Evidence.OBSERVED
    return Evidence.TESTED if cases else Evidence.RULE


def _concerns(remark: str, number: str) -> bool:
    """Whether a remark about a class belongs to another that holds it."""
    known = remark in levin_classes()
    return remark == number or (known and number in above(remark))


def _by_second(rows: Rows) -> dict[str, tuple[str, ...]]:
    found: dict[str, set[str]] = defaultdict(set)
    for first, second in rows:
        found[second].add(first)
    return {key: tuple(sorted(each)) for key, each in found.items()}


def _needs(number: str, verb: str, lacking: Sequence[str]) -> tuple[str, ...]:
    said = {
        row["need"]: row["words"]
        for row in table("needs")
        if row["class"] == number and row["verb"] == verb
    }
    return tuple(said.get(each, "a primitive of this class with this verb") for each in lacking)


def _senses(words: Sequence[PrimitiveWords]) -> Iterable[SenseRow]:
    for link in thesis_senses():
        yield _sense_row(link)
    for word in sorted(words):
        for link in sense_links(word):
            yield _sense_row(link)


def _sense_row(link: SenseLink) -> SenseRow:
    if link.key not in wordnet():
        return SenseRow(link, None, 0)
    synset = wordnet().of_key(link.key)
    number = next((sense.number for sense in synset.senses if sense.key == link.key), 0)
    return SenseRow(link, synset, number)


def _coverage(
    classes: Sequence[ClassReport], seen: Sequence[Seen], showing: Iterable[Seen]
) -> Coverage:
    verbs = [each for report in classes for each in report.verbs]
    return Coverage(
        classes=len(classes),
        classes_addressed=sum(each.status is Status.ADDRESSED for each in classes),
        classes_partly=sum(each.status is Status.PARTLY for each in classes),
        verbs=len(verbs),
        verbs_addressed=sum(verb.how is How.ADDRESSED for verb in verbs),
        verbs_general=sum(verb.how is How.GENERAL for verb in verbs),
        verbs_purpose=sum(verb.how is How.PURPOSE for verb in verbs),
        segments=total(seen),
        segments_named=total(each for each in seen if each.primitive),
        segments_in_classes=total(showing),
        unstated=len(unstated_classes()),
    )


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
