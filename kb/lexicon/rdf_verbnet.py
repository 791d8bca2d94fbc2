"""VerbNet's classes as statements, and back."""

from collections.abc import Iterable, Mapping, Sequence

from pyoxigraph import Literal, NamedNode, Triple

from kb.lexicon import terms
from kb.lexicon.levin import levin_classes
from kb.lexicon.terms import LABEL, TYPE, Triples
from kb.lexicon.verbnet import Frame, Member, Phrase, Predicate, Role, VerbClass
from kb.lexicon.wordnet import WordNet
from kb.store import names
from ontology import CAPAR

BROADER = NamedNode(terms.SKOS + "broader")
NOTATION = NamedNode(terms.SKOS + "notation")


def verbnet_triples(classes: Iterable[VerbClass], words: WordNet) -> Triples:
    """Every class with what it states itself; senses where that WordNet has them."""
    for top in classes:
        for verb_class in top.family:
            yield from _class(verb_class, words)


def _class(value: VerbClass, words: WordNet) -> Triples:
    node = terms.verbnet(value.id)
    yield Triple(node, TYPE, CAPAR.VerbNetClass)
    yield Triple(node, LABEL, Literal(value.id))
    yield Triple(node, NOTATION, Literal(value.number))
    if value.parent:
        yield Triple(node, BROADER, terms.verbnet(value.parent))
    if value.levin in levin_classes():
        yield Triple(node, CAPAR.levinClass, terms.levin(value.levin))
    for index, member in enumerate(value.members):
        yield from _member(node, index, member, words)
    for index, role in enumerate(value.roles):
        own = names.part(node, "role", index)
        yield Triple(node, CAPAR.thematicRole, own)
        yield Triple(own, TYPE, CAPAR.ThematicRole)
        yield Triple(own, LABEL, Literal(role.name))
        yield Triple(own, CAPAR.index, terms.number(index))
        for restriction in role.restrictions:
            yield Triple(own, CAPAR.restriction, Literal(restriction))
    for index, frame in enumerate(value.frames):
        yield from _frame(node, index, frame)


def _member(of: NamedNode, index: int, member: Member, words: WordNet) -> Triples:
    own = names.part(of, "member", index)
    yield Triple(of, CAPAR.classMember, own)
    yield Triple(own, TYPE, CAPAR.ClassMember)
    yield Triple(own, CAPAR.lemma, Literal(member.lemma.replace("_", " ")))
    yield Triple(own, CAPAR.memberVerb, terms.verb(member.lemma))
    for key in member.keys:
        yield Triple(own, CAPAR.senseKey, Literal(key))
        if key in words:
            yield Triple(own, CAPAR.memberSense, terms.sense(key))


def _frame(of: NamedNode, index: int, frame: Frame) -> Triples:
    own = names.part(of, "frame", index)
    syntax = "; ".join(f"{each.kind} {each.value}".strip() for each in frame.syntax)
    yield Triple(of, CAPAR.verbFrame, own)
    yield Triple(own, TYPE, CAPAR.VerbFrame)
    yield Triple(own, CAPAR.index, terms.number(index))
    yield Triple(own, CAPAR.pattern, Literal(frame.pattern))
    yield Triple(own, CAPAR.example, Literal(frame.example))
    yield Triple(own, CAPAR.syntax, Literal(syntax))
    for number, predicate in enumerate(frame.semantics):
        node = names.part(own, "predicate", number)
        yield Triple(own, CAPAR.semanticPredicate, node)
        yield Triple(node, TYPE, CAPAR.SemanticPredicate)
        yield Triple(node, CAPAR.index, terms.number(number))
        yield Triple(node, CAPAR.predicateName, Literal(predicate.name))
        yield Triple(node, CAPAR.holds, Literal(predicate.holds))
        yield Triple(node, CAPAR.arguments, Literal("|".join(predicate.arguments)))


Row = Mapping[str, object]


def classes_from(
    heads: Iterable[Row],
    members: Iterable[Row],
    roles: Iterable[Row],
    frames: Iterable[Row],
    predicates: Iterable[Row],
) -> tuple[VerbClass, ...]:
    """The classes that rows of the store state, each without its subclasses."""
    tables = [_grouped(rows) for rows in (members, roles, frames, predicates)]
    return tuple(
        _class_of(row, *(table.get(str(row["id"]), []) for table in tables)) for row in heads
    )


def _class_of(
    head: Row,
    members: Sequence[Row],
    roles: Sequence[Row],
    frames: Sequence[Row],
    predicates: Sequence[Row],
) -> VerbClass:
    meanings = _grouped(predicates, "frame")
    ordered = sorted(frames, key=lambda row: int(str(row["frame"])))
    return VerbClass(
        str(head["id"]),
        str(head["parent"] or ""),
        _members(members),
        _roles(roles),
        tuple(_frame_of(row, meanings.get(str(row["frame"]), [])) for row in ordered),
        (),
    )


def _grouped(rows: Iterable[Row], by: str = "id") -> dict[str, list[Row]]:
    table: dict[str, list[Row]] = {}
    for row in rows:
        table.setdefault(str(row[by]), []).append(row)
    return table


def _members(rows: Sequence[Row]) -> tuple[Member, ...]:
    keys: dict[str, list[str]] = {}
    for row in rows:
        found = keys.setdefault(str(row["lemma"]).replace(" ", "_"), [])
        if row["key"]:
            found.append(str(row["key"]))
    return tuple(Member(lemma, tuple(sorted(each))) for lemma, each in sorted(keys.items()))


def _roles(rows: Sequence[Row]) -> tuple[Role, ...]:
    restrictions: dict[tuple[int, str], list[str]] = {}
    for row in rows:
        found = restrictions.setdefault((int(str(row["index"])), str(row["role"])), [])
        if row["restriction"]:
            found.append(str(row["restriction"]))
    return tuple(
        Role(role, tuple(sorted(each))) for (_, role), each in sorted(restrictions.items())
    )


def _frame_of(row: Row, predicates: Sequence[Row]) -> Frame:
    ordered = sorted(predicates, key=lambda each: int(str(each["place"])))
    return Frame(
        str(row["pattern"]),
        str(row["example"]),
        tuple(_phrase(each) for each in str(row["syntax"]).split("; ") if each),
        tuple(
            Predicate(
                str(each["name"]),
                tuple(str(each["arguments"]).split("|")),
                holds=bool(each["holds"]),
            )
            for each in ordered
        ),
    )


def _phrase(text: str) -> Phrase:
    kind, _, value = text.partition(" ")
    return Phrase(kind, value)
