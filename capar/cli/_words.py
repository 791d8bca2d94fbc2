"""What the commands about words share: the rule base's words, the store, JSON out."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

if TYPE_CHECKING:
    from kb.lexicon.links import PrimitiveWords
    from kb.store.stores import Store


def rule_words(rules: Path | None, actionary: str | None = None) -> "tuple[PrimitiveWords, ...]":
    """What the primitives that ship, and those that people wrote, are called."""
    from capar.cli._rules import rule_base
    from capar.pipelines.linguistic_report import primitive_files, primitive_words

    return primitive_words(primitive_files(rule_base("extended", rules, actionary).added))


@contextmanager
def open_words(where: str | None) -> "Iterator[Store | None]":
    """The store of an Actionary to read; None where none is named and none stands here."""
    from kb.store.embedded import DATA_FOLDER
    from kb.store.schema import prove_current
    from kb.store.stores import is_address, open_store, place

    target = place(where)
    # The folder of an Actionary may hold rules before it holds anything that was observed.
    if where is None and not is_address(target) and not (Path(target) / DATA_FOLDER).is_dir():
        yield None
        return
    store = open_store(target, read_only=not is_address(target))
    try:
        prove_current(store)
        yield store
    finally:
        store.close()


def print_json(value: Any) -> None:
    """A value of ours as JSON on standard output."""
    import dataclasses
    import json

    def plain(each: Any) -> Any:
        if dataclasses.is_dataclass(each) and not isinstance(each, type):
            return {
                field.name: plain(getattr(each, field.name)) for field in dataclasses.fields(each)
            }
        if isinstance(each, dict):
            return {str(key): plain(inner) for key, inner in each.items()}
        if isinstance(each, list | tuple):
            return [plain(inner) for inner in each]
        return each

    typer.echo(json.dumps(plain(value), ensure_ascii=False, indent=2, sort_keys=True, default=str))
