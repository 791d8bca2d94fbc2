"""The audit: shipped rules are clean, and what is wrong with others is found."""

from functools import cache

import pytest

from capar_rules.engine.profiles import profile
from capar_rules.lint.audit import Audit
from capar_rules.lint.world_checks import audit

pytestmark = pytest.mark.long


@cache
def audited(name: str) -> Audit:
    """The audit of shipped rules, made once for all that is asked of it."""
    return audit(profile(name))


@pytest.fixture(params=["thesis", "extended"])
def shipped(request):
    return audited(request.param)


def test_the_shipped_rules_are_clean(shipped):
    assert shipped.ambiguous == ()
    assert shipped.shadowed == ()
    assert shipped.unreachable == ()
    assert shipped.clean


def test_every_feature_set_has_a_name_by_the_rules_that_we_observe_by():
    assert audited("extended").uncovered == ()


def test_every_case_that_the_published_rules_leave_has_one_reason():
    shipped = audited("thesis")
    assert shipped.uncovered
    assert sorted({features for features, _ in shipped.excused}) == list(shipped.uncovered)
    assert all(len(reason.split()) > 5 for _, reason in shipped.excused)


def test_two_names_without_order_are_ambiguous_and_what_no_body_can_do_is_never_fitted(tmp_path):
    """A thing that is possessed throughout cannot come to be touched within the segment."""
    rules = tmp_path / "added.lp"
    rules.write_text(
        'primitive("Grasp").\nfeature_row("Grasp", any, "1", "1", "0", "0").\n'
        'primitive("Odd").\nfeature_row("Odd", any, "101", "010", "00", "00").\n'
    )
    found = audit(profile("thesis", added=(rules,)))
    (clash,) = found.ambiguous
    assert (clash.first, clash.second) == ("Grasp", "Touch")
    assert clash.features == (("1", "1", "0", "0"),)
    assert not found.clean
    assert found.unreachable == ("Odd",)
