"""A look at a C3D file's counts against its length, before a native library trusts them."""

import re
import struct
from dataclasses import dataclass
from pathlib import Path

from capar.model.errors import FileError

BLOCK = 512
_NAME = re.compile(r"[A-Z0-9_ ]+")
_ORDERS = {84: "<", 85: "<", 86: ">"}


@dataclass(frozen=True)
class _Entry:
    """One parameter: its group, name, and integers if it holds such."""

    group: int
    name: str
    values: tuple[float, ...]


def check_layout(path: Path, data: bytes) -> None:
    """Prove that parameters and frames lie inside the file.

    Raises:
        FileError: They do not; the message says what the header promises.
    """
    start = (data[0] - 1) * BLOCK
    if len(data) < start + 4 or data[start + 3] not in _ORDERS:
        raise FileError(path, "is cut short before its parameters.", "Export it again.")
    order, blocks = _ORDERS[data[start + 3]], data[start + 2]
    end = start + blocks * BLOCK
    if blocks == 0 or end > len(data):
        raise FileError(path, f"promises {blocks} blocks of parameters and ends before.")
    groups, entries = _walk(path, data[start:end], order, vax=data[start + 3] == 85)
    _check_frames(path, data, order, groups, entries)


def _walk(
    path: Path, section: bytes, order: str, *, vax: bool
) -> tuple[dict[str, int], list[_Entry]]:
    groups: dict[str, int] = {}
    entries: list[_Entry] = []
    at = 4
    while at + 2 <= len(section):
        length, number = struct.unpack_from("bb", section, at)
        if length == 0 or number == 0:
            break
        name_end = at + 2 + abs(length)
        _inside(path, section, name_end + 2)
        name = section[at + 2 : name_end].decode("latin-1").upper()
        if length == -128 or not _NAME.fullmatch(name):
            raise FileError(path, f"has a parameter called {name[:20]!r}; it is damaged.")
        (step,) = struct.unpack_from(order + "h", section, name_end)
        if number < 0:
            groups[name] = -number
        else:
            entries.append(
                _entry(path, section, name_end + 2, group=number, name=name, order=order, vax=vax)
            )
        if step < 0:
            raise FileError(path, f"has a parameter {name!r} that leads back; it is damaged.")
        if step == 0:
            break
        at = name_end + step
        _inside(path, section, at)
    return groups, entries


def _inside(path: Path, section: bytes, at: int) -> None:
    if at > len(section):
        raise FileError(path, "has a parameter that reaches beyond its section; it is damaged.")


def _entry(
    path: Path, section: bytes, at: int, *, group: int, name: str, order: str, vax: bool
) -> _Entry:
    _inside(path, section, at + 2)
    kind, ranks = struct.unpack_from("bB", section, at)
    _inside(path, section, at + 2 + ranks)
    sizes = section[at + 2 : at + 2 + ranks]
    count = 1
    for each in sizes:
        count *= each
    if kind not in {-1, 1, 2, 4} or ranks > 7:
        raise FileError(path, f"has parameter {name!r} of unknown kind {kind}; it is damaged.")
    begin = at + 2 + ranks
    _inside(path, section, begin + count * abs(kind))
    form = {1: "B", 2: "H"}.get(kind)
    if form:
        return _Entry(group, name, struct.unpack_from(f"{order}{count}{form}", section, begin))
    if kind == 4 and not vax:
        return _Entry(group, name, struct.unpack_from(f"{order}{count}f", section, begin))
    return _Entry(group, name, ())


def _check_frames(
    path: Path, data: bytes, order: str, groups: dict[str, int], entries: list[_Entry]
) -> None:
    points, analogs, first, last = struct.unpack_from(f"{order}4H", data, 2)
    (data_block,) = struct.unpack_from(f"{order}H", data, 16)
    known = {(each.group, each.name): each.values for each in entries}

    def value(group: str, name: str, default: float) -> float:
        found = known.get((groups.get(group, -1), name), ())
        return found[0] if found else default

    point_group = [name for (_, name) in known if name == "USED"]
    if "POINT" not in groups or not point_group:
        raise FileError(path, "has no POINT parameters; it is damaged.")
    if value("POINT", "USED", points) != points:
        raise FileError(path, "counts its points differently in header and parameters.")
    width = 2 if value("POINT", "SCALE", -1.0) > 0.0 else 4
    frames = last - first + 1
    needed = frames * (points * 4 + analogs) * width
    room = len(data) - (data_block - 1) * BLOCK
    if data_block == 0 or frames <= 0 or needed > room:
        raise FileError(
            path,
            f"promises {frames} frames of {points} points ({needed} bytes) and has room "
            f"for {max(room, 0)} bytes.",
            "It is cut short; copy or export it again.",
        )
