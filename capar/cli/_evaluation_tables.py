"""The tables of an evaluation, for people: scores, confusions, and the worst stretches of time."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

SHOWN = 12
"""Rows of confusions and of the worst stretches that are printed; JSON has more."""

MOST_PARTS = 20
"""So many links, bodies, objects or events have a row each; JSON has all."""

Scores = Mapping[str, Any]
Cell = Callable[[Scores], str]


def print_evaluation(out: "Console", result: Mapping[str, Any]) -> None:
    """Print a report as tables."""
    kind = str(result["kind"])
    out.print(_scores(kind, result))
    if kind == "actions":
        out.print(_confusions(result["all"]))
        for name in ("missed", "inserted"):
            counts = ", ".join(f"{each} {n}" for each, n in result["all"][name].items())
            out.print(f"segments {name}: {counts or 'none'}", markup=False)
    if result["worst"]:
        out.print(_worst(result["worst"][:SHOWN]))
    for line in _remarks(kind, result):
        out.print(line, markup=False, soft_wrap=True)


def _remarks(kind: str, result: Mapping[str, Any]) -> Iterator[str]:
    everything = result["all"]
    if kind == "carries":
        sharp = everything["moving_at_both_ends"]
        yield (
            f"{everything['excluded']} of {everything['carries']} carries are excluded, as nothing "
            f"moves in them; a carry counts as found within {everything['within_s']:g} s"
        )
        yield (
            f"of {sharp['carries']} whose object moves at both labelled ends: start "
            f"{_number(sharp['start'])}, end {_number(sharp['end'])}, both "
            f"{_number(sharp['both'])} %"
        )
    yield from result["notices"]
    part = PARTS[kind]
    if result[f"unlabelled_{part}"]:
        names = ", ".join(result[f"unlabelled_{part}"])
        yield f"not counted, because they bear no labels: {names}"


def _scores(kind: str, result: Mapping[str, Any]) -> "Table":
    from rich.markup import escape

    columns = COLUMNS[kind]
    part = PARTS[kind]
    captures = len(result["captures"])
    table = _table(f"{captures} capture{'s' * (captures != 1)}", CAPTIONS[kind])
    for index, column in enumerate((part, *columns)):
        table.add_column(
            column, justify="right" if index else "left", no_wrap=bool(index), overflow="fold"
        )
    for name, scores in _rows(part, result):
        if scores is None:
            table.add_section()
            continue
        table.add_row(escape(name), *(cell(scores) for cell in columns.values()))
    return table


def _rows(part: str, result: Mapping[str, Any]) -> Iterator[tuple[str, Scores | None]]:
    """Parts and whole; then each group's, then each capture's whole."""
    shown = list(result[part].items())
    yield from shown if len(shown) <= MOST_PARTS else ()
    yield "all", result["all"]
    for name, group in result["groups"].items():
        yield "", None
        own = list(group[part].items())
        if len(own) <= MOST_PARTS:
            yield from ((f"{name}: {each}", scores) for each, scores in own)
        yield f"{name}: all", group["all"]
    if len(result["by_capture"]) > 1:
        yield "", None
        yield from ((name, scores["all"]) for name, scores in result["by_capture"].items())


def _confusions(scored: Mapping[str, Any]) -> "Table":
    wrong = [each for each in scored["confusion"] if each["true"] != each["predicted"]]
    table = _table("frames under another label")
    for column in ("true", "predicted"):
        table.add_column(column, overflow="fold")
    table.add_column("frames", justify="right")
    table.add_column("share", justify="right")
    for confusion in wrong[:SHOWN]:
        share = f"{100 * confusion['frames'] / scored['frames']:.1f} %"
        table.add_row(confusion["true"], confusion["predicted"], str(confusion["frames"]), share)
    if len(wrong) > SHOWN:
        table.add_row("...", "...", str(sum(each["frames"] for each in wrong[SHOWN:])), "")
    return table


def _worst(found: Sequence[Mapping[str, Any]]) -> "Table":
    table = _table("longest stretches that differ [s]")
    for column in ("capture", "of", "from", "to", "labelled", "found", "segments"):
        table.add_column(
            column, overflow="fold", justify="right" if column in {"from", "to"} else "left"
        )
    from rich.markup import escape

    for span in found:
        texts = [escape(span[key]) for key in ("capture", "channel", "true", "found", "segments")]
        times = (f"{span['start_s']:.2f}", f"{span['end_s']:.2f}")
        table.add_row(*texts[:2], *times, *texts[2:])
    return table


def _table(title: str, caption: str = "") -> "Table":
    from rich.box import SIMPLE_HEAD
    from rich.markup import escape
    from rich.table import Table

    return Table(
        title=escape(title),
        caption=escape(caption) or None,
        title_justify="left",
        caption_justify="left",
        box=SIMPLE_HEAD,
        collapse_padding=True,
        pad_edge=False,
    )


def _score(key: str) -> Cell:
    return lambda scores: _number(scores[key])


def _count(key: str) -> Cell:
    return lambda scores: str(scores[key])


def _error(key: str) -> Cell:
    return lambda scores: f"{_whole(scores[key]['median'])} / {_whole(scores[key]['p95'])}"


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.1f}"


def _whole(value: float | None) -> str:
    return "-" if value is None else f"{value:.0f}"


PARTS = {
    "actions": "links",
    "contacts": "bodies",
    "carries": "objects",
    "events": "events",
    "containers": "containers",
}

COLUMNS: dict[str, dict[str, Cell]] = {
    "actions": {
        "accuracy": _score("accuracy"),
        "F1": _score("macro_f1"),
        "F1@10": _score("f1@10"),
        "@25": _score("f1@25"),
        "@50": _score("f1@50"),
        "edit": _score("edit"),
        "onset": _error("onset_ms"),
        "offset": _error("offset_ms"),
    },
    "contacts": {
        "frames": _count("frames"),
        "precision": _score("precision"),
        "recall": _score("recall"),
        "F1": _score("f1"),
        "onset": _error("onset_ms"),
        "offset": _error("offset_ms"),
    },
    "carries": {
        "carries": _count("counted"),
        "start": _score("start"),
        "end": _score("end"),
        "both": _score("both"),
        "start off": _error("start_ms"),
        "end off": _error("end_ms"),
        "extra": _count("extra"),
    },
    "events": {
        "seen": _count("seen"),
        "found": _count("found"),
        "missed": _count("missed"),
        "open": _count("open"),
        "extra": _count("extra"),
        "F1": _score("f1"),
        "away": _error("away_ms"),
    },
    "containers": {
        "objects": _count("objects"),
        "right": _count("right"),
        "went in": _count("went_in"),
        "told": _count("told"),
        "told wrongly": _count("told_wrongly"),
        "untold": _count("untold"),
    },
}
"""What is printed of each kind of labels, and from which scores."""

CAPTIONS = {
    "actions": "onset, offset: median / 95th percentile of the size of the error [ms]",
    "contacts": "all: whether any body touches; frame by frame [%]\n"
    "onset, offset: median / 95th percentile of the way to the nearest found one [ms]",
    "carries": "start, end, both: carries whose printed ends are near the labelled ones [%]\n"
    "off: median / 95th percentile of the size of the error [ms]",
    "containers": "went in: the middle lies in the container at the end and did not before",
    "events": "away: median / 95th percentile of the way from what was seen to what was found [ms]",
}
