"""Write labels of what was observed, for the pipelines of others."""

from collections import Counter
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer
from typer import Argument, Option

from capar.cli import options
from capar.cli.output import check_new_folder, check_writable, progress, written
from capar.model.errors import CaparError
from capar.model.par import UNKNOWN


class Format(StrEnum):
    """How labels are written."""

    CSV = "csv"
    JSON = "json"
    PARQUET = "parquet"
    ELAN = "elan"
    PRAAT = "praat"
    LEROBOT = "lerobot"


FOLDERS = (Format.ELAN, Format.PRAAT, Format.LEROBOT)
"""Formats of which the output is a folder."""


def label(
    captures: Annotated[
        list[str], Argument(help="Captures: folders, patterns with *, FOLDER:TAKE or FOLDER:*.")
    ],
    output: Annotated[
        Path, Option("--output", "-o", help="A file; of elan, praat and lerobot a new folder.")
    ],
    form: Annotated[
        Format | None,
        Option("--format", help="How they are written; else as the file's name ends, else csv."),
    ] = None,
    per_frame: Annotated[
        bool, Option("--per-frame", help="A row a frame of each end-effector (csv, json, parquet).")
    ] = False,
    vocabulary: Annotated[
        Path | None,
        Option(metavar="FILE", help="Other labels for our names, as `capar evaluate --mapping`."),
    ] = None,
    dataset: Annotated[
        Path | None,
        Option(
            metavar="FOLDER", help="Of lerobot: the data set to copy; else that of the captures."
        ),
    ] = None,
    effector: Annotated[str, Option(metavar="NAME", help="Of lerobot: whose segments.")] = "",
    profile: options.ProfileName = "extended",
    rules: options.Rules = None,
    actionary: options.Beside = None,
    steady: options.Steady = None,
) -> None:
    r"""Write what was observed as labels for other programs.

    They are segments, contacts, possessions and motions, each a row or an annotation. A segment
    has its name, more general names, objects and their kinds, what it reached, where bodies are, a
    sentence and the rule that named it.

    \b
        capar label 'study:*' -o labels.parquet
        capar label demos --per-frame -o frames.csv --vocabulary words.toml
        capar label take1 take2 -o annotations --format elan
        capar label 'robot_data:*' --format lerobot -o labelled_data
    """
    from capar.evaluation.labelling import label as labels
    from capar.evaluation.labelling import write_labels
    from capar.evaluation.plan import read_mapping
    from extractors.readers.bundle.patterns import find_captures
    from extractors.readers.file_access import arrow

    format_ = form or next((f for f in Format if output.suffix in {"", f".{f}"}), None)
    if format_ is None:
        raise CaparError(f"{output}: say in which format: --format {'|'.join(Format)}")
    if dataset is not None and format_ is not Format.LEROBOT:
        raise CaparError("--format lerobot takes --dataset FOLDER, and no other format does")
    if per_frame and format_ in FOLDERS:
        raise CaparError(f"{format_} has no rows by frame; leave out --per-frame, or write csv")
    if format_ in FOLDERS:
        check_new_folder(output)
    else:
        check_writable(output)
    if format_ in {Format.PARQUET, Format.LEROBOT}:
        arrow()
    mapping = read_mapping(vocabulary) if vocabulary else None
    base = options.rule_base(profile, rules, actionary, steady=steady)
    places = find_captures(captures)
    if format_ is Format.LEROBOT:
        from capar.evaluation.lerobot import data_set_of

        dataset = dataset or data_set_of(places)
    told_of = progress("observing")(places)
    rows = list(labels(told_of, per_frame=per_frame, vocabulary=mapping, rules=base))
    if dataset is not None:
        from capar.evaluation.lerobot import write_subtasks

        counts = write_subtasks(rows, dataset, output, effector=effector)
        told = f"{sum(counts.values())} subtasks of {len(counts)} episodes"
    elif format_ in FOLDERS:
        count = len(write_labels(rows, format_, output))
        told = f"{count} file{'s' * (count != 1)}"
    else:
        with written(output) as draft:
            write_labels(rows, format_, draft)
        told = f"{len(rows)} rows of {len(places)} capture{'s' * (len(places) != 1)}"
    nameless = {
        (row["capture"], row["effector"], row.get("segment", row.get("first")))
        for row in rows
        if row["name"] == UNKNOWN
    }
    if unknown := Counter(capture for capture, *_ in nameless):
        told += f"; {sum(unknown.values())} segments Unknown, of {', '.join(sorted(unknown))}"
    typer.echo(f"wrote {output}: {told}")
