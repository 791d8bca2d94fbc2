"""Device addresses: ``flock:/dev/ttyUSB0?birds=12&format=pos_quat&rate=51.65``."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from urllib.parse import unquote

from capar.model.capture import NAME
from capar.model.errors import DeviceError, UnknownNameError

FLAGS = {"yes": True, "no": False}


@dataclass(frozen=True)
class Address:
    """A driver's name, where its device is, and options; each option is asked for once."""

    text: str
    kind: str
    place: str
    options: Mapping[str, str]
    _asked: set[str] = field(default_factory=set, repr=False, compare=False)

    def text_of(self, name: str, default: str) -> str:
        """An option as text."""
        self._asked.add(name)
        return self.options.get(name, default)

    def choice(self, name: str, known: Iterable[str], default: str) -> str:
        """An option that is one of some words.

        Raises:
            UnknownNameError: It is another.
        """
        given, names = self.text_of(name, default), list(known)
        if given not in names:
            raise UnknownNameError(name, given, names, where=self.text)
        return given

    def flag(self, name: str, *, default: bool) -> bool:
        """An option that is ``yes`` or ``no``.

        Raises:
            UnknownNameError: It is something else.
        """
        return FLAGS[self.choice(name, FLAGS, "yes" if default else "no")]

    def number(self, name: str, default: float, *, low: float, high: float) -> float:
        """An option that is a number within bounds, which belong to it.

        Raises:
            DeviceError: It is no number, or lies outside.
        """
        given = self.text_of(name, str(default))
        try:
            value = float(given)
        except ValueError:
            raise self.error(f"{name}={given} is no number") from None
        if not low <= value <= high:
            raise self.error(f"{name}={given}; it lies between {low:g} and {high:g}")
        return value

    def integer(self, name: str, default: int, *, low: int, high: int) -> int:
        """An option that is a whole number within bounds, which belong to it.

        Raises:
            DeviceError: It is none, or lies outside.
        """
        value = self.number(name, default, low=low, high=high)
        if value != int(value):
            raise self.error(f"{name}={self.options[name]} is no whole number")
        return int(value)

    def names(self, default: Iterable[str]) -> tuple[str, ...]:
        """The sensors' names: the option ``names``, as many as there are sensors.

        Raises:
            DeviceError: There are more or fewer, one is given twice, or it is no name.
        """
        usual = tuple(default)
        given = tuple(self.text_of("names", ",".join(usual)).split(","))
        if len(given) != len(usual):
            raise self.error(f"names= lists {len(given)} names; there are {len(usual)} sensors")
        for name in given:
            if not NAME.fullmatch(name):
                rule = "begin with a lower-case letter and hold letters, digits and underscores"
                raise self.error(f"sensor name {name!r}: names {rule}")
        if len(set(given)) < len(given):
            raise self.error("names= lists a name twice")
        return given

    def host_port(self, port: int) -> tuple[str, int]:
        """The place as ``HOST`` or ``HOST:PORT``.

        Raises:
            DeviceError: It is neither.
        """
        host, colon, digits = self.place.rpartition(":")
        if not colon:
            return self.place, port
        if not host or not digits.isascii() or not digits.isdigit() or not 0 < int(digits) < 65536:
            raise self.error(f"{self.place!r} is no HOST or HOST:PORT")
        return host, int(digits)

    def close(self) -> None:
        """Refuse options that nothing asked for.

        Raises:
            UnknownNameError: There is one.
        """
        for name in self.options:
            if name not in self._asked:
                raise UnknownNameError("option", name, self._asked, where=self.text)

    def error(self, problem: str) -> DeviceError:
        """An error that names this address."""
        return DeviceError(f"{self.text}: {problem}")


def parse_address(text: str) -> Address:
    """The address that a text holds.

    Raises:
        DeviceError: It has no driver, no place, an option without a value, or one twice.
    """
    kind, colon, rest = text.partition(":")
    place, _, query = rest.partition("?")
    if not colon or not kind or not place:
        raise DeviceError(
            f"{text!r} is no device address; it is DRIVER:PLACE?OPTION=VALUE&..., "
            "like flock:/dev/ttyUSB0?birds=2"
        )
    options: dict[str, str] = {}
    for part in query.split("&") if query else ():
        name, equals, value = part.partition("=")
        if not equals or not name or not value:
            raise DeviceError(f"{text}: option {part!r} is not of the form NAME=VALUE")
        if name in options:
            raise DeviceError(f"{text}: option {name!r} is given twice")
        options[name] = unquote(value)
    return Address(text, kind, place, options)
