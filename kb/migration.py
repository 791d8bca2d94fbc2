"""Bringing an Actionary of an older schema to the present one, with a backup first."""

from dataclasses import dataclass
from pathlib import Path

from capar.model.errors import FileError
from kb.errors import SchemaError
from kb.exchange import export
from kb.schema_steps import STEPS, migration
from kb.store import schema, updates
from kb.store.stores import Store, is_address, open_store


@dataclass(frozen=True, slots=True)
class Migrated:
    """What became of an Actionary."""

    place: str
    found: int
    """The version that it had."""

    backup: Path | None
    """Where it stands as it was, as N-Quads; None if it was of the present version."""


def migrate(place: str, *, backup: Path | None = None, wait_s: float = 0.0) -> Migrated:
    """Bring an Actionary to the present schema, all or nothing of it.

    Args:
        place: Its folder, or its server's address.
        backup: Where it is exported to before; beside the folder if left out.
        wait_s: How long to wait for another writer [s].

    Raises:
        FileError: The backup is there already, or a server's has no name.
        LockedError: Another process writes the folder.
        SchemaError: A newer program wrote it.
        StoreError: There is no Actionary, or it cannot be used.
    """
    open_store(place, read_only=True).close()
    store = open_store(place, wait_s=wait_s)
    try:
        found = schema.version(store)
        if found in {None, schema.SCHEMA}:
            return Migrated(place, schema.SCHEMA, None)
        if found not in STEPS:
            raise SchemaError(place, found or 0, schema.remedy(place, found or 0))
        file = backup or _beside(place, found)
        _back_up(store, file)
        store.change(" ;\n".join([*migration(store, found), updates.ontology_replacement()]))
        return Migrated(place, found, file)
    finally:
        store.close()


def _beside(place: str, found: int) -> Path:
    if is_address(place):
        raise FileError(place, "is a server.", "Say where its backup goes: --backup FILE.nq")
    folder = Path(place).absolute()
    return folder.with_name(f"{folder.name}.schema-{found}.nq")


def _back_up(store: Store, file: Path) -> None:
    try:
        with file.open("xb") as target:
            target.write(export(store, "nquads", runs=True))
    except FileExistsError:
        raise FileError(file, "exists already.", "Name another file: --backup FILE.nq") from None
