"""Rule profiles: the main rule file, and at which frames a link has its ticks."""

from dataclasses import dataclass
from pathlib import Path

from capar.model.errors import UnknownNameError
from capar_rules.engine.solver import fingerprint, rule_file


@dataclass(frozen=True)
class Profile:
    """A rule base: shipped rules and those that users add."""

    name: str
    crossings_only: bool
    """Whether events can stand at zero crossings alone (thesis 4.3.2)."""

    added: tuple[Path, ...] = ()
    """Rule files of the user, in addition to the shipped ones."""

    steady: bool = False
    """Whether flicker is resolved with the fewest changes before anything is derived."""

    @property
    def files(self) -> tuple[Path, ...]:
        """Every file to load; the main one includes the other shipped ones.

        All primitives count in ``extended``, so that a new one needs no line elsewhere; ``thesis``
        includes the published seven.
        """
        every = () if self.name == "thesis" else sorted(rule_file("primitives").glob("*.lp"))
        return (rule_file(f"{self.name}.lp"), *every, *self.added)

    @property
    def fingerprint(self) -> str:
        """SHA-256 of the rule base."""
        flicker = (rule_file("segmentation/flicker.lp"),) if self.steady else ()
        return fingerprint((*self.files, *flicker))


DEFAULT = "extended"
_CROSSINGS_ONLY = {"extended": False, "thesis": True}


def profile(
    name: str = DEFAULT, *, added: tuple[Path, ...] = (), steady: bool | None = None
) -> Profile:
    """The profile of that name, with rule files added to it unchecked.

    ``added``: rule files of the user. ``steady``: whether to resolve flicker; None for what is
    usual in the profile: ``extended`` does, and ``thesis`` takes contacts as they were measured.

    Raises:
        UnknownNameError: There is none.
    """
    if name not in _CROSSINGS_ONLY:
        raise UnknownNameError("profile", name, _CROSSINGS_ONLY)
    crossings_only = _CROSSINGS_ONLY[name]
    return Profile(name, crossings_only, added, not crossings_only if steady is None else steady)
