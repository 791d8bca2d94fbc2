"""Numbers are written as a person writes them, and names with digits stay what they are."""

import pytest

from capar.model.figures import figure, figures, rounded


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.11599999999999999, "0.116"),
        (14.116666666666667, "14.117"),
        (0.02491987158875227, "0.02492"),
        (2.0, "2"),
        (-0.0, "0"),
        (1.2345678e-7, "1.235e-07"),
        (1234567.8919, "1234567.892"),
    ],
)
def test_a_number_has_a_thousandth_or_four_digits(value: float, text: str) -> None:
    assert figure(value) == text


def test_numbers_in_a_text_are_written_so_and_names_are_not_touched() -> None:
    assert figures("mean 0.30000000000000004 +- 1.5E-1") == "mean 0.3 +- 0.15"
    assert figures("v1.2000, take:0.5000 and mug") == "v1.2000, take:0.5000 and mug"


def test_programs_get_six_places() -> None:
    assert rounded(14.116666666666667, 6) == 14.116667
    assert rounded(0.00060138321645, 6) == 0.0006013832
