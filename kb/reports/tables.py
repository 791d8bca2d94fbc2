"""The linguistic report as tables: what every plain format shows, once."""

from kb.lexicon.links import ThesisClaim
from kb.reports.linguistics import ClassReport, LinguisticReport, SenseRow, share

Table = tuple[str, tuple[str, ...], tuple[tuple[str, ...], ...]]
"""Title, heads of columns, rows."""

EVIDENCE = (
    "Observed: stored segments of captures bear a primitive's name; tested: a shipped test case "
    "does, and no stored segment; by rule only: a rule says so, and nothing shows it yet."
)
"""What counts as evidence, for the captions of the tables that tell it."""

NOTES = {
    "Coverage": "Counts what rules address, whatever the evidence.",
    "Classes": f"Shown by: stored captures and shipped test cases. {EVIDENCE}",
    "Verbs": EVIDENCE,
    "Claims of the thesis": "What the thesis says, in its own words; no evidence of the system's.",
}
"""What stands below a table's title."""

DOUBTS = "Doubts about what rule files state"


def tables(report: LinguisticReport) -> tuple[Table, ...]:
    """Every table, in the order of the report."""
    return (
        ("Coverage", ("what", "how much"), coverage(report)),
        (
            "Classes",
            ("class", "title", "thesis", "system", "by", "why", "shown by", "segments"),
            tuple(_class_row(each) for each in report.classes),
        ),
        (
            "Verbs",
            ("class", "verb", "system", "by", "what it lacks", "WordNet 3.1", "gloss"),
            tuple(row for each in report.classes for row in _verb_rows(each)),
        ),
        (
            "Senses",
            ("primitive", "verb", "1.6", "3.1", "sense key", "ILI", "gloss", "who", "remark"),
            tuple(map(_sense_row, report.senses)),
        ),
        (
            "Claims of the thesis",
            ("class", "verbs", "status", "why", "section", "sentence"),
            tuple(map(_claim_row, report.claims)),
        ),
        (
            "Remarks",
            ("class", "verb", "remark"),
            tuple((each.levin, each.verb, each.text) for each in report.remarks),
        ),
        *_doubts(report),
    )


def _doubts(report: LinguisticReport) -> tuple[Table, ...]:
    """The table of doubts, if there are any."""
    rows = tuple((each,) for each in report.doubts)
    return ((DOUBTS, ("doubt",), rows),) if rows else ()


def coverage(report: LinguisticReport) -> tuple[tuple[str, str], ...]:
    """The figures of coverage as people read them."""
    total = report.coverage
    members = "with VerbNet's members" if report.verbnet else "named by the thesis or our rules"
    return (
        ("classes addressed", share(total.classes_addressed, total.classes)),
        ("classes addressed in part", share(total.classes_partly, total.classes)),
        (f"verbs addressed ({members})", share(total.verbs_addressed, total.verbs)),
        ("verbs not addressed, only what is more general", share(total.verbs_general, total.verbs)),
        ("verbs only as a purpose that the user states", share(total.verbs_purpose, total.verbs)),
        ("observed segments that a rule names", share(total.segments_named, total.segments)),
        ("observed segments in a class", share(total.segments_in_classes, total.segments)),
        ("classes of which the thesis says nothing", str(total.unstated)),
        ("observations", str(len(report.observations))),
    )


def shown_by(each: ClassReport) -> str:
    """The evidence of a class in a line, long lists cut."""
    places = list(dict.fromkeys(f"{proof.where} ({proof.primitive})" for proof in each.proofs))
    more = f" and {len(places) - 4} more" if len(places) > 4 else ""
    return ", ".join(places[:4]) + more


def _class_row(each: ClassReport) -> tuple[str, ...]:
    return (
        each.number,
        each.title,
        ", ".join(each.thesis),
        each.status.words,
        ", ".join([*each.primitives, *each.files]),
        each.reason,
        shown_by(each),
        str(each.segments),
    )


def _verb_rows(each: ClassReport) -> list[tuple[str, ...]]:
    return [
        (
            each.number,
            verb.verb,
            verb.standing,
            ", ".join(verb.primitives),
            "; ".join(verb.lacks),
            " ".join(sense.ili or sense.offset for sense in verb.senses),
            " / ".join(sense.definition for sense in verb.senses),
        )
        for verb in each.verbs
    ]


def _sense_row(row: SenseRow) -> tuple[str, ...]:
    link = row.link
    return (
        link.primitive,
        link.verb,
        str(link.number_1_6 or ""),
        str(row.number_3_1 or ""),
        link.key,
        row.synset.ili if row.synset else "",
        row.synset.definition if row.synset else "not in WordNet 3.1",
        link.claimed_by.value,
        link.remark,
    )


def _claim_row(claim: ThesisClaim) -> tuple[str, ...]:
    said = f" (printed: {claim.said})" if claim.said not in {"", claim.levin} else ""
    return (
        f"{claim.levin}{said}",
        ", ".join(claim.verbs),
        claim.status.value,
        claim.reason,
        claim.section,
        claim.quote,
    )
