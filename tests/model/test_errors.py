"""A misspelt name is answered with the names that exist, the nearest of many."""

from hypothesis import given
from hypothesis import strategies as st

from capar.model.errors import MOST_LISTED, NEAREST, UnknownNameError

NAMES = st.text("abcdefgh_", min_size=1, max_size=12)


def test_a_few_names_are_all_listed() -> None:
    error = UnknownNameError("body", "mgu", ["table", "mug"], where="capture.toml:3")
    assert str(error) == "capture.toml:3: no body 'mgu'; there are: mug, table. Did you mean 'mug'?"


def test_a_name_in_other_capitals_is_the_nearest() -> None:
    names = ["Lift", "MoveObj", "Rest", *(f"Step{number}" for number in range(30))]
    assert str(UnknownNameError("action", "LIFT", names)).endswith("Did you mean 'Lift'?")
    assert "the nearest: Rest, " in str(UnknownNameError("action", "rest", names))


def test_without_any_name_it_says_none() -> None:
    assert str(UnknownNameError("take", "one", [])) == "no take 'one'; there are: none."


def test_of_many_names_the_nearest_five_are_listed_and_all_are_counted() -> None:
    names = [f"marker_{number:03d}" for number in range(164)] + ["right_hand"]
    error = UnknownNameError("body", "rigth_hand", names)
    text = str(error)
    assert text.startswith("no body 'rigth_hand'; there are 165, the nearest: right_hand, ")
    assert text.endswith("Did you mean 'right_hand'?")
    assert text.count(",") == NEAREST
    assert error.known == sorted(names)


@given(st.sets(NAMES), NAMES)
def test_no_message_grows_with_the_number_of_names(names: set[str], wrong: str) -> None:
    text = str(UnknownNameError("body", wrong, names))
    assert sum(f"{name}" in text for name in names) >= min(len(names), NEAREST)
    assert len(text) < 120 + 15 * MOST_LISTED
