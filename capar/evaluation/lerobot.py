"""Subtasks in a copy of a LeRobot data set: rows of style ``subtask`` in ``language_persistent``.

A row is active from its timestamp until the next one of its style; every frame of an episode holds
all rows of the episode, as LeRobot's own annotation pipeline writes them.
"""

import json
import re
import shutil
from collections.abc import Iterable, Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

from capar.evaluation.labelling import Row
from capar.model.errors import CaparError, FileError, UnknownNameError
from extractors.readers.bundle.capture_toml import find_place, open_bundle
from extractors.readers.file_access import arrow
from extractors.readers.schema.capture import MotionFile
from extractors.readers.schema.entry import expanded

PERSISTENT, EVENTS, STYLE = "language_persistent", "language_events", "subtask"
FEATURE = {"dtype": "language", "shape": [1], "names": None}
INFO = Path("meta") / "info.json"


def write_subtasks(
    rows: Iterable[Row], dataset: Path, output: Path, *, effector: str = ""
) -> dict[int, int]:
    """Copy a data set with the segments of captures as subtasks; how many each episode has.

    The number that ends a capture's name is its episode: ``robot:episode_000003``. A subtask
    begins at the first frame that is not before its segment; equal ones in a row are one, and of
    several that begin with one frame only the last is written, since LeRobot refuses two at once.
    It reads as the segment's label, or as its name and objects where no vocabulary gave it another.
    Other rows of the column stay, and so do episodes without a capture.

    Args:
        rows: Labels of captures, as ``label`` gives them, not by frame.
        dataset: A folder with meta/info.json and data/**/*.parquet.
        output: A new folder.
        effector: Whose segments they are, where several act.

    Raises:
        FileError: There is no such data set, or the output is there already.
        CaparError: A capture is of no episode, or several end-effectors act.
    """
    subtasks = _subtasks(rows, effector)
    if not (dataset / INFO).is_file():
        raise FileError(dataset, f"is no LeRobot data set: it has no {INFO}.", "Name its folder.")
    if output.exists():
        raise FileError(output, "exists already.", "Name a new folder.")
    info = json.loads((dataset / INFO).read_text(encoding="utf-8"))
    files = sorted((dataset / "data").rglob("*.parquet"))
    parquet = arrow() and import_module("pyarrow.parquet")
    episodes = {
        number
        for path in files
        for number in parquet.read_table(path, columns=["episode_index"])[0].unique().to_pylist()
    }
    if missing := sorted(set(subtasks) - episodes):
        raise UnknownNameError(
            "episode", str(missing[0]), [str(each) for each in sorted(episodes)], where=str(dataset)
        )
    shutil.copytree(dataset, output)
    info["features"] |= {PERSISTENT: FEATURE, EVENTS: FEATURE}
    text = json.dumps(info, indent=4, ensure_ascii=False)
    (output / INFO).write_text(text + "\n", encoding="utf-8")
    counts: dict[int, int] = {}
    for path in files:
        counts |= _rewrite(parquet, output / path.relative_to(dataset), subtasks)
    return dict(sorted(counts.items()))


def data_set_of(places: Iterable[str]) -> Path:
    """The data set that captures are read from.

    Raises:
        CaparError: They are read from none, or from several, or not from the first frame on.
    """
    bundles = {find_place(place)[0]: place for place in places}
    documents = [open_bundle(place)[0] for place in bundles.values()]
    for document in documents:
        if document.from_s:
            raise document.error(
                "from_s", "labels count from an episode's first frame.", "Leave it out."
            )
    files = [file for document in documents for file in document.files.values()]
    found = dict.fromkeys(
        expanded(file, "path") for file in files if isinstance(file, MotionFile) and file.episode
    )
    if len(found) != 1:
        problem = f"these captures are read from {' and '.join(map(str, found)) or 'none'}"
        raise CaparError(f"--format lerobot copies one data set; {problem}: say --dataset FOLDER")
    return next(iter(found))


def _subtasks(rows: Iterable[Row], effector: str) -> dict[int, list[tuple[float, str]]]:
    """The start [s] and the text of each subtask, by episode."""
    out: dict[int, list[tuple[float, str]]] = {}
    captures: dict[str, list[Row]] = {}
    for row in rows:
        if row.get("row") == "segment":
            captures.setdefault(row["capture"], []).append(row)
    for capture, segments in captures.items():
        acting = dict.fromkeys(each["effector"] for each in segments)
        chosen = effector or next(iter(acting))
        if not effector and len(acting) > 1:
            handling = dict.fromkeys(each["effector"] for each in segments if each["objects"])
            chosen = next(iter(handling), chosen)
            if len(handling) > 1:
                raise CaparError(
                    f"{capture}: {' and '.join(handling)} act, and a frame has one subtask; choose "
                    "one with --effector NAME"
                )
        if chosen not in acting:
            raise UnknownNameError("end-effector", chosen, acting, where=capture)
        number = re.search(r"(\d+)$", capture)
        if number is None:
            raise CaparError(
                f"{capture}: of which episode is it? The number that ends a capture's name says it,"
                " as in robot:episode_3"
            )
        if int(number[1]) in out:
            raise CaparError(f"{capture}: another capture is of episode {int(number[1])} too")
        own = out.setdefault(int(number[1]), [])
        for each in segments:
            if each["effector"] == chosen:
                text = _words(each) if each["label"] == each["name"] else each["label"]
                if not own or own[-1][1] != text:
                    own.append((each["start_s"], text))
    return out


def _words(segment: Row) -> str:
    """A segment in words: ``put down large table``."""
    name = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", segment["name"]).lower()
    return " ".join([name, *(each.replace("_", " ") for each in segment["objects"])])


def _rewrite(
    parquet: Any, path: Path, subtasks: Mapping[int, list[tuple[float, str]]]
) -> dict[int, int]:
    """Put the columns into a file, a row group an episode; how many subtasks each has."""
    pa = arrow()
    calls = pa.list_(pa.string())
    event = [("role", pa.string()), ("content", pa.string()), ("style", pa.string()),
             ("camera", pa.string()), ("tool_calls", calls)]  # fmt: skip
    kinds = {
        PERSISTENT: pa.list_(pa.struct([*event[:3], ("timestamp", pa.float32()), *event[3:]])),
        EVENTS: pa.list_(pa.struct(event)),
    }
    table = parquet.read_table(path)
    numbers = table["episode_index"].to_pylist()
    times = table["timestamp"].to_pylist()
    before = table[PERSISTENT].to_pylist() if PERSISTENT in table.column_names else []
    rows: dict[int, list[dict[str, Any]]] = {}
    counts: dict[int, int] = {}
    for n, number in enumerate(numbers):
        if number not in rows:
            stamps = [time for time, own in zip(times, numbers, strict=True) if own == number]
            kept = [each for each in (before[n] if before else None) or []
                    if number not in subtasks or each["style"] != STYLE]  # fmt: skip
            texts = {_stamp(start_s, stamps): text for start_s, text in subtasks.get(number, [])}
            added = [
                {"role": "assistant", "content": text, "style": STYLE, "camera": None,
                 "tool_calls": None, "timestamp": stamp}
                for stamp, text in texts.items() if stamp is not None
            ]  # fmt: skip
            counts |= {number: len(added)} if number in subtasks else {}
            rows[number] = sorted([*kept, *added], key=lambda e: (e["timestamp"], e["style"] or ""))
    column = pa.array([rows[number] for number in numbers], kinds[PERSISTENT])
    events = pa.array([[]] * len(numbers), kinds[EVENTS])
    if PERSISTENT in table.column_names:
        table = table.drop_columns([PERSISTENT])
    table = table.append_column(PERSISTENT, column)
    if EVENTS not in table.column_names:
        table = table.append_column(EVENTS, events)
    table = table.replace_schema_metadata(None)  # features of other columns than there are now
    with parquet.ParquetWriter(path, table.schema) as writer:
        starts = [n for n in range(len(numbers)) if n == 0 or numbers[n] != numbers[n - 1]]
        for start, end in zip(starts, [*starts[1:], len(numbers)], strict=True):
            writer.write_table(table.slice(start, end - start), row_group_size=end - start)
    return counts


def _stamp(start_s: float, stamps: list[float]) -> float | None:
    """The first timestamp of an episode not before a time since its beginning, if there is one."""
    since = stamps[0] + start_s - 1e-4  # as timestamps are of single precision
    return next((each for each in stamps if each >= since), None)
