"""A copy of all that an Actionary holds, from which it can be made again."""

from collections.abc import Sequence
from pathlib import Path

from capar.model.errors import FileError
from kb.errors import StoreError
from kb.exchange import export, read
from kb.store.stores import Store


def back_up(store: Store, file: Path) -> int:
    """Write every statement, when and where observations were made included, as N-Quads.

    Every statement is read first, and the file is read again when it is written.

    Returns:
        How many statements it holds.

    Raises:
        FileError: The file is there already.
        DamagedError: A statement cannot be read.
        StoreError: The file does not hold what the store does.
    """
    store.check_readable()
    data = export(store, "nquads", runs=True)
    try:
        with file.open("xb") as target:
            target.write(data)
    except FileExistsError:
        raise FileError(file, "exists already.", "Name another file.") from None
    kept = len(read(file.read_bytes(), "nquads", path=file)) if data else 0
    held = len(set(store.quads()))
    if kept != held:
        file.unlink()
        raise StoreError(f"{file}: {kept} statements were written of {held}; try again")
    return kept


def back_up_rules(folder: Path | None, file: Path) -> Sequence[Path]:
    """Copy the rule files that stand in an Actionary's folder into a folder beside its backup."""
    rules = sorted(folder.glob("*.lp")) if folder and folder.is_dir() else []
    beside = file.with_name(f"{file.stem}.rules")
    copies = []
    for rule_file in rules:
        beside.mkdir(exist_ok=True)
        copies.append(beside / rule_file.name)
        copies[-1].write_bytes(rule_file.read_bytes())
    return copies
