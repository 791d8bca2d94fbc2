"""Words into an Actionary: WordNet's verbs, Levin's classes, the primitives' links, VerbNet."""

from pathlib import Path
from typing import Annotated

import typer

from capar.cli._options import New, Rules, confirm_new, opened

app = typer.Typer(no_args_is_help=True, help="Words in an Actionary: WordNet, Levin, VerbNet.")

Where = Annotated[
    str | None, typer.Option(help="Folder or address; else CAPAR_ACTIONARY, else ./actionary.")
]


@app.command()
def load(actionary: Where = None, rules: Rules = None, new: New = False) -> None:
    """Put WordNet's verbs, Levin's classes and the primitives' links into the Actionary, once."""
    from capar.cli._options import rule_words
    from kb.actionary import Actionary
    from kb.lexicon.loading import load_words

    confirm_new(actionary, new=new)
    words = rule_words(rules, opened(actionary))
    with Actionary.open(actionary) as book:
        loaded = load_words(book.store, words)
    typer.echo("The words are loaded." if loaded else "The words were there already.")


@app.command("import")
def import_words(
    source: Annotated[str, typer.Argument(help="What to import: verbnet.")],
    folder: Annotated[Path, typer.Argument(help="The folder with VerbNet's XML files.")],
    actionary: Where = None,
    new: New = False,
    json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """Read VerbNet 3.x from your own copy into the Actionary, in place of an earlier one."""
    from capar.cli._output import print_json
    from capar.model.errors import UnknownNameError
    from kb.actionary import Actionary
    from kb.lexicon.loading import load_verbnet
    from kb.lexicon.verbnet_files import key_rate, read_verbnet
    from kb.lexicon.wordnet import wordnet

    if source != "verbnet":
        raise UnknownNameError("source of words", source, ("verbnet",))
    confirm_new(actionary, new=new)
    classes = read_verbnet(folder)
    rate = key_rate(classes, wordnet())
    with Actionary.open(actionary) as book:
        loaded = load_verbnet(book.store, classes, wordnet())
    every = [each for top in classes for each in top.family]
    figures = {
        "files": len(classes),
        "classes": len(every),
        "members": sum(len(each.members) for each in every),
        "keys": rate.keys,
        "keys_resolved": rate.resolved,
        "loaded": loaded,
    }
    if json:
        print_json(figures, sort_keys=True)
        return
    typer.echo(
        f"{len(classes)} files with {len(every)} classes and {figures['members']} members; "
        f"{rate.resolved} of {rate.keys} WordNet keys ({100 * rate.share:.1f} %) "
        "are in WordNet 3.1."
    )
    if not loaded:
        typer.echo("The Actionary had them already.")
