"""Labels of what was observed, for the pipelines of others: rows of tables, and annotations.

A row is a segment, a contact, a possession or a motion, or a frame of an end-effector.
"""

import csv
import json
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib import import_module
from itertools import groupby
from pathlib import Path
from typing import Any

from capar.evaluation.plan import LabelMapping, check_names, known_names, labelled, read_mapping
from capar.model.capture import Capture
from capar.model.errors import CaparError, UnknownNameError
from capar.model.facts import MovedBy, Touching
from capar.model.observation import Observation, ObservedLink, Segment
from capar.pipelines.language import segment_sentence
from capar.pipelines.linguistic_report import primitive_files, primitive_words
from capar.pipelines.observation import observe
from capar_rules.engine.profiles import DEFAULT, Profile, profile
from extractors.readers.bundle.patterns import find_captures
from extractors.readers.file_access import arrow

Row = dict[str, Any]

COLUMNS: Mapping[str, type] = {
    "capture": str, "row": str, "agent": str, "effector": str, "side": str, "start_s": float,
    "end_s": float, "first": int, "last": int, "name": str, "label": str, "general": list,
    "objects": list, "kinds": list, "goal": str, "prepositions": list, "sentence": str,
    "rule": str, "version": str,
}  # fmt: skip
"""Columns of labels and what they hold; lists are of texts. ``row`` is ``segment``, ``contact``,
``possession`` or ``motion``."""

FRAME_COLUMNS: Mapping[str, type] = {
    "capture": str, "frame": int, "time_s": float, "agent": str, "effector": str, "side": str,
    "segment": int, "name": str, "label": str, "objects": list, "touches": list, "holds": list,
}  # fmt: skip
"""Columns of labels by frame: what an end-effector does, touches and possesses in it."""


def label(
    captures: Iterable[Capture | Observation | Path | str],
    *,
    per_frame: bool = False,
    vocabulary: LabelMapping | Path | str | None = None,
    rules: Profile | str = DEFAULT,
) -> Iterator[Row]:
    """Labels of captures as rows, capture by capture.

    Args:
        captures: Observations, captures, or patterns of their places.
        per_frame: Whether a row is a frame of an end-effector; else it is a segment, a contact, a
            possession or a motion.
        vocabulary: A file of rules that map our names to other labels, or what was read of it.
        rules: The rule profile to observe with, or its name.

    Raises:
        CaparError: A capture or the vocabulary has a fault, or two captures have one name.
    """
    base = profile(rules) if isinstance(rules, str) else rules
    mapping = read_mapping(Path(vocabulary)) if isinstance(vocabulary, str | Path) else vocabulary
    words = () if per_frame else primitive_words(primitive_files(base.added))
    names = set[str]()
    for given in captures:
        places: Sequence[Any] = [given]
        if isinstance(given, str | Path):
            places = find_captures([str(given)])
        for place in places:
            seen = place if isinstance(place, Observation) else observe(place, rules=base)
            if seen.capture in names:
                where = f"; one is {place}" if isinstance(place, str) else ""
                raise CaparError(f"two captures are called {seen.capture!r}{where}: rename one")
            names.add(seen.capture)
            if mapping is not None:
                objects = [each.name for each in seen.objects]
                known = known_names([seen], base)
                check_names(mapping, names=known, objects=objects, labels=mapping.labels)
            yield from _frames(seen, mapping) if per_frame else _rows(seen, mapping, words)


def _labels(link: ObservedLink, mapping: LabelMapping | None) -> list[str]:
    """The label of each segment: its name, or the one that the vocabulary gives it."""
    if mapping is None:
        return [each.name for each in link.segments]
    return [each.label for each in labelled(link, mapping)]


def _rows(seen: Observation, mapping: LabelMapping | None, words: Sequence[Any]) -> Iterator[Row]:
    """Segments, contacts, possessions and motions of an observation."""
    kinds = {each.name: each.kind for each in seen.objects}
    sides = {each.ee: each.side for each in seen.links}
    rules = {each.name: each.file for each in seen.naming}
    goals = {(each.ee, each.frame): each.goal for each in seen.locations}
    empty: Row = {name: [] if kind is list else "" for name, kind in COLUMNS.items()}
    empty |= {"capture": seen.capture, "version": seen.version}

    def row(what: str, effector: str, first: int, last: int, objects: Sequence[str]) -> Row:
        return empty | {
            "row": what, "agent": seen.performer(effector) if effector in sides else "",
            "effector": effector, "side": sides.get(effector, ""), "first": first, "last": last,
            "start_s": first / seen.rate_hz, "end_s": last / seen.rate_hz, "name": what,
            "label": what, "objects": list(objects), "kinds": [kinds.get(o, "") for o in objects],
        }  # fmt: skip

    for link in seen.links:
        for segment, own in zip(link.segments, _labels(link, mapping), strict=True):
            yield row("segment", link.ee, segment.first, segment.last, segment.objects) | {
                "start_s": segment.start_s, "end_s": segment.end_s, "name": segment.name,
                "label": own, "general": list(segment.general),
                "goal": goals.get((link.ee, segment.last), ""),
                "prepositions": [f"{a} {how} {b}" for how, a, b in segment.prepositions],
                "sentence": segment_sentence(seen, segment, words=words),
                "rule": rules.get(segment.name, ""),
            }  # fmt: skip
    for fact in seen.facts:
        if isinstance(fact, Touching):
            yield row("contact", fact.body, fact.first, fact.last, [fact.other])
    for link in seen.links:
        for held, run in groupby(link.segments, _held):
            segments = list(run)
            if held:
                yield row("possession", link.ee, segments[0].first, segments[-1].last, [held])
    for fact in seen.facts:
        if isinstance(fact, MovedBy):
            how = {"name": fact.how, "label": fact.how}
            yield row("motion", fact.mover, fact.first, fact.last, [fact.object]) | how


def _held(segment: Segment) -> str:
    """The object that is possessed in a segment; empty if none is."""
    return segment.objects[0] if segment.possessed else ""


def _frames(seen: Observation, mapping: LabelMapping | None) -> Iterator[Row]:
    """Each frame of each end-effector; that of a border is of the segment that begins there."""
    touching = [each for each in seen.facts if isinstance(each, Touching)]
    for link in seen.links:
        labels, last = _labels(link, mapping), len(link.segments) - 1
        own = [each for each in touching if link.ee in {each.body, each.other}]
        for n, segment in enumerate(link.segments):
            for frame in range(segment.first, segment.last + (n == last)):
                yield {
                    "capture": seen.capture, "frame": frame, "time_s": frame / seen.rate_hz,
                    "agent": seen.performer(link.ee), "effector": link.ee, "side": link.side,
                    "segment": segment.index, "name": segment.name, "label": labels[n],
                    "objects": list(segment.objects),
                    "touches": sorted(
                        fact.other if fact.body == link.ee else fact.body
                        for fact in own
                        if fact.first <= frame <= fact.last
                    ),
                    "holds": [_held(segment)] if segment.possessed else [],
                }  # fmt: skip


def _csv(rows: list[Row], path: Path) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, _columns(rows), lineterminator="\n")
        writer.writeheader()
        writer.writerows(
            {k: ";".join(v) if isinstance(v, list) else v for k, v in row.items()} for row in rows
        )


def _json(rows: list[Row], path: Path) -> None:
    lines = ",\n".join(json.dumps(row, ensure_ascii=False) for row in rows)
    path.write_text(f"[\n{lines}\n]\n" if rows else "[]\n", encoding="utf-8")


def _columns(rows: list[Row]) -> Mapping[str, type]:
    return FRAME_COLUMNS if rows and "frame" in rows[0] else COLUMNS


def _parquet(rows: list[Row], path: Path) -> None:
    pa = arrow()
    kinds = {str: pa.string(), float: pa.float64(), int: pa.int64(), list: pa.list_(pa.string())}
    schema = pa.schema([(name, kinds[kind]) for name, kind in _columns(rows).items()])
    import_module("pyarrow.parquet").write_table(pa.Table.from_pylist(rows, schema), path)


def _tiers(rows: list[Row]) -> dict[str, list[tuple[float, float, str]]]:
    """Annotations by tier: what each end-effector does, touches, possesses and moves."""
    tiers: dict[str, list[tuple[float, float, str]]] = {}
    for row in rows:
        what, objects = row["row"], " ".join(row["objects"])
        name = row["effector"] if what == "segment" else f"{row['effector']} {what}"
        if what in {"contact", "motion"}:  # which overlap, of several bodies
            name, objects = f"{name} {objects}", row["name"] if what == "motion" else objects
        text = f"{row['label']} {objects}".strip() if what == "segment" else objects
        tiers.setdefault(name, []).append((row["start_s"], row["end_s"], text))
    return tiers


def _elan(rows: list[Row], path: Path) -> None:
    """A tier is an end-effector, or one of its contacts, possessions or motions; to the ms."""
    from pympi import Eaf

    file = Eaf(author="capar")
    file.adocument["DATE"] = "1970-01-01T00:00:00+00:00"  # the same input, the same bytes
    file.remove_tier("default")
    for name, annotations in _tiers(rows).items():
        file.add_tier(name)
        for start, end, text in annotations:
            first, last = round(start * 1000), round(end * 1000)
            if first < last:
                file.add_annotation(name, first, last, text)
    file.to_file(str(path))


def _praat(rows: list[Row], path: Path) -> None:
    """The same as interval tiers, to the last digit of a time."""
    from pympi import TextGrid

    file = TextGrid(xmax=max((row["end_s"] for row in rows), default=1.0))
    for name, annotations in _tiers(rows).items():
        tier = file.add_tier(name)
        for start, end, text in annotations:
            if start < end:
                tier.add_interval(start, end, text)
    file.to_file(str(path))


@dataclass(frozen=True)
class Form:
    """A form in which labels are written."""

    suffix: str
    write: Callable[[list[Row], Path], None]
    each: bool = False
    """Whether a file holds one capture."""


FORMS = {
    "csv": Form(".csv", _csv),
    "json": Form(".json", _json),
    "parquet": Form(".parquet", _parquet),
    "elan": Form(".eaf", _elan, each=True),
    "praat": Form(".TextGrid", _praat, each=True),
}
"""Forms by name; ``lerobot`` is a copy of a data set (``capar.evaluation.lerobot``)."""


def write_labels(rows: Iterable[Row], form: str, output: Path) -> list[Path]:
    """Write labels; of ELAN and Praat each capture to a file of its name in a folder.

    Raises:
        UnknownNameError: There is no such form.
        CaparError: The form has no rows by frame.
    """
    if form not in FORMS:
        raise UnknownNameError("format of labels", form, [*FORMS, "lerobot"])
    own, known = FORMS[form], list(rows)
    if not own.each:
        own.write(known, output)
        return [output]
    if known and "frame" in known[0]:
        raise CaparError(f"{form} holds intervals; leave out --per-frame, or write csv or parquet")
    output.mkdir(parents=True, exist_ok=True)
    paths = []
    for capture, run in groupby(known, lambda row: row["capture"]):
        paths.append(output / f"{re.sub(r'[^A-Za-z0-9_.-]', '_', capture)}{own.suffix}")
        own.write(list(run), paths[-1])
    return paths
