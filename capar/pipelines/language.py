"""The pipelines from captures to language: tellings, fitting verbs, and what can be said."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from capar.model.capture import Capture
from capar.model.facts import Moving, OfAgent, Touching
from capar.model.observation import Observation, Segment, find_segment, split_capture
from capar.pipelines.linguistic_report import primitive_files, primitive_words
from kb.language.describe import Detail
from kb.language.describe import describe as told
from kb.language.vocabulary import EFFECTORS, Vocabulary
from kb.lexicon.links import PrimitiveWords, levin_classes
from kb.lexicon.loading import has_source, verbnet_class_of
from kb.lexicon.verbnet import VerbClass
from kb.lexicon.verbs import Fit, fitting
from kb.lexicon.verbs import SegmentFeatures as SegmentSeen
from ontology import CAPAR

if TYPE_CHECKING:
    from capar_rules.engine.profiles import Profile
    from kb.store.stores import Store

CONTACT_CLASSES = frozenset(
    ["9", "10", "11", "12", "13", "15", "16", "17", "18", "19", "20", "22", "39", "40"]
)
"""Levin's chapters whose verbs say what a body does to things and to itself."""

SPOKEN = frozenset([Touching, Moving, OfAgent])
"""Facts that the sentence of one segment needs."""


def describe(
    seen: Observation | Capture | Path | str,
    *,
    detail: Detail = "steps",
    timed: bool = False,
    words: Sequence[PrimitiveWords] | None = None,
) -> str:
    """Say in plain English what was done.

    Args:
        seen: An observation, or a capture or its place, which is observed first.
        detail: ``steps`` describes every step, ``summary`` only those that changed something.
        timed: Whether each step is followed by its time [s].
        words: What the primitives are called; by default as the rules that ship call them.

    Raises:
        CaparError: The capture has a fault.
    """
    from capar.pipelines.observation import observe

    observation = seen if isinstance(seen, Observation) else observe(seen)
    known = primitive_words(primitive_files()) if words is None else words
    return told(observation, detail=detail, timed=timed, words=known)


def segment_sentence(
    seen: Observation, segment: Segment, *, words: Sequence[PrimitiveWords] | None = None
) -> str:
    """Say in plain English what was done in one segment; empty where nothing was touched.

    Args:
        seen: The observation that it is of.
        segment: One of its segments.
        words: What the primitives are called; by default as the rules that ship call them.
    """
    if not segment.objects:
        return ""
    owner = next(link for link in seen.links if link.ee == segment.ee)
    alone = replace(
        seen,
        agent=next(
            (one for one in seen.others if one.name == seen.performer(segment.ee)), seen.agent
        ),
        others=(),
        links=(replace(owner, segments=(replace(segment, index=0),)),),
        facts=tuple(one for one in seen.facts if type(one) in SPOKEN),
        joint=(),
        relations=(),
        notices=(),
    )
    return describe(alone, words=words)


def verbs_for(
    segment: str,
    words: Sequence[PrimitiveWords],
    *,
    store: "Store | None" = None,
    rules: "Profile | str" = "extended",
) -> tuple[Fit, ...]:
    """The verbs that fit a segment, best first.

    Raises:
        AddressError: It is no address of a segment, or names no capture.
        UnknownNameError: There is no segment at it.
        CaparError: The capture cannot be read.
    """
    from capar.pipelines.observation import observe

    capture, place = split_capture(segment)
    observation = observe(capture, rules=rules)
    found = find_segment(observation.links, place, capture=observation.capture)
    seen = SegmentSeen(found.name, found.general, found.features)
    classes: list[VerbClass] = []
    if store and has_source(store, "verbnet"):
        for number in levin_classes():
            if number.partition(".")[0] in CONTACT_CLASSES:
                classes += verbnet_class_of(store, number)
    return fitting(seen, words, tuple(classes))


def vocabulary(words: Sequence[PrimitiveWords], store: "Store | None" = None) -> Vocabulary:
    """What sentences can refer to: with a store, only the objects and agents that it knows."""
    if store is None:
        return Vocabulary(tuple(words))

    def names(where: str) -> set[str]:
        rows = store.ask(f"SELECT DISTINCT ?name WHERE {{ {where} }}").plain()
        return {str(row["name"]) for row in rows if row["name"]}

    objects = names(f"?thing {CAPAR.tag} ?tag ; {CAPAR.name} ?name")
    kinds = names(f"?thing {CAPAR.kind}/{CAPAR.name} ?name")
    effectors = names(f"?link {CAPAR.ee} ?name")
    agents = names(f"?seen {CAPAR.agent}/{CAPAR.name} ?name")
    return Vocabulary(
        tuple(words),
        frozenset(objects | kinds) if objects else None,
        frozenset({*EFFECTORS, *effectors}),
        frozenset(agents),
    )
