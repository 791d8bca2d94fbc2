"""Keep what a person says of a segment beside what the machine says."""

import csv
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from capar.cli._options import Place, Wait, require_actionary
from capar.cli._output import check_writable, print_json, written

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kb.corrections import Span

app = typer.Typer()

COLUMNS = ("link", "start_s", "end_s", "label", "object")
"""Of a table of labels, as `capar evaluate` reads it."""


@app.command()
def correct(
    segment: Annotated[
        str,
        typer.Argument(
            metavar="SEGMENT", help="CAPTURE/END_EFFECTOR/INDEX; CAPTURE alone shows its account."
        ),
    ],
    name: Annotated[str, typer.Option(help="What was done in it.")] = "",
    start: Annotated[float | None, typer.Option(metavar="SECONDS", help="When it began.")] = None,
    end: Annotated[float | None, typer.Option(metavar="SECONDS", help="When it ended.")] = None,
    split: Annotated[
        float | None, typer.Option(metavar="SECONDS", help="It is two, of which one ends here.")
    ] = None,
    join: Annotated[bool, typer.Option("--join", help="It is one with the next.")] = False,
    by: Annotated[str, typer.Option(metavar="PERSON", help="Who says so.")] = "",
    labels: Annotated[
        Path | None, typer.Option(help="Write the account as labels, a CSV table, to this file.")
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
    wait: Wait = 0.0,
    actionary: Place = None,
) -> None:
    """Keep a person's claim about a SEGMENT, and print what was done according to all claims.

    The machine's segments stay as they are, and claims stay when the capture is observed again.
    Segments are counted as this command prints them. `capar query --corrected` asks what persons
    say; `capar query corrections` lists their claims.
    """
    from capar.model.segment_address import split_capture
    from kb import Actionary
    from kb.corrections import Correction, account
    from kb.corrections import correct as claim

    if labels is not None:
        check_writable(labels)
    require_actionary(actionary, observed=True)
    asked = (name, start, end, split, join) != ("", None, None, None, False)
    capture, address = segment, None
    if asked or by:
        capture, address = split_capture(segment)
    change = Correction(name, start, end, split, join) if address else None
    with Actionary.open(actionary, read_only=change is None, wait_s=wait) as opened:
        if address and change:
            from dataclasses import replace

            claim(opened.store, replace(address, capture=capture), change, by=by)
            _note_new_name(name, actionary)
        spans = account(opened.store, capture)
    if labels is not None:
        _write_labels(labels, spans)
    _print(capture, spans, json=json)


def _note_new_name(name: str, actionary: str | None) -> None:
    """Say that no rule gives the name, which may be meant so, with the nearest that one gives."""
    from difflib import get_close_matches

    from capar.cli._options import rule_words
    from capar.model.par import UNKNOWN

    known = [words.name for words in rule_words(None, actionary)]
    if name and name not in {*known, UNKNOWN}:
        near = get_close_matches(name, known, n=1)
        hint = f"; did you mean {near[0]!r}?" if near else ""
        typer.echo(f"note: no rule gives the name {name!r}{hint}", err=True)


def _print(capture: str, spans: "Sequence[Span]", *, json: bool) -> None:
    if json:
        print_json(list(spans))
        return
    counts: dict[str, int] = {}
    for span in spans:
        at = counts[span.ee] = counts.get(span.ee, -1) + 1
        who = f"  says {span.by}" if span.by else ""
        typer.echo(
            f"{capture}/{span.ee}/{at}  {span.start_s:.3f} to {span.end_s:.3f} s  {span.name}{who}"
        )


def _write_labels(path: Path, spans: "Sequence[Span]") -> None:
    with written(path) as draft, draft.open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(COLUMNS)
        for span in spans:
            first = span.objects.split(" ")[0]
            table.writerow((span.ee, span.start_s, span.end_s, span.name, first))
