"""The measured inputs of the rules, written into ``inputs.lp`` from the kinds of facts.

Run ``make docs`` after a kind of fact was added or its docstring changed.
"""

import inspect
from dataclasses import fields
from typing import Any

from capar.model.facts import ALL_FACT_KINDS
from capar_rules.engine.solver import rule_file

BORDERS = "% Borders."
"""Where the part begins that is written by hand."""

HEAD = """\
%* What the rules are given: facts, and their borders numbered outside. *%

% Facts, written by `make docs` from capar/model/facts.py. Frames are counted from zero; intervals
% are closed, [First, Last].
"""


def inputs(text: str) -> str:
    """The text of ``inputs.lp`` with a line for each kind of fact."""
    return HEAD + "".join(map(_line, ALL_FACT_KINDS)) + "\n" + text[text.index(BORDERS) :]


def _line(kind: Any) -> str:
    names = [n.upper() if n == "ee" else n.capitalize() for n in (f.name for f in fields(kind))]
    atom = f"{kind.predicate}({', '.join(names)})" if names else kind.predicate
    meaning = " ".join((inspect.getdoc(kind) or "").partition("\n\n")[0].replace("``", "").split())
    return f"#defined {kind.predicate}/{len(names)}.".ljust(28) + f"% {atom}: {meaning}\n"


if __name__ == "__main__":
    path = rule_file("inputs.lp")
    path.write_text(inputs(path.read_text(encoding="utf-8")), encoding="utf-8")
