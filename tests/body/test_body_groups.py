"""The table of groups: what follows from its rows holds for every row."""

import numpy as np
import pytest

from elbowroom.body.bones import PARENTS
from elbowroom.body.dof import (
    CHILDREN,
    DOF,
    LOCAL,
    LOCAL_GROUPS,
    SEARCH_ORDER,
    DofGroup,
    Turning,
    clamp,
    columns_of,
    group_of_bone,
    limits,
    side_by_side,
)
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.pose.kinematics import body_model, group_capsules, posture_capsules


def test_the_groups_are_a_tree_and_each_is_searched_after_what_it_depends_on() -> None:
    for place, group in enumerate(SEARCH_ORDER):
        before = {DofGroup.ROOT, *SEARCH_ORDER[:place]}
        assert group.parent in before
        assert set(group.clear_of) <= before
    assert set(SEARCH_ORDER) == set(LOCAL_GROUPS)
    assert {group.parent for group in CHILDREN} == {SEARCH_ORDER[0]}


def test_their_components_fill_a_configuration_without_gaps() -> None:
    places = np.concatenate([np.arange(DOF)[group.at] for group in DofGroup])
    assert np.array_equal(places, np.arange(DOF))
    parts = {group: np.arange(LOCAL, dtype=np.float64)[None, columns_of(group)] for group in LOCAL_GROUPS}
    assert np.array_equal(side_by_side(parts)[0], np.arange(LOCAL))


def test_every_bone_that_is_turned_belongs_to_one_group_and_hangs_on_its_parents() -> None:
    turned = [bone for group in DofGroup for bone in group.value.bones]
    assert len(turned) == len(set(turned))
    for group in LOCAL_GROUPS:
        for bone in group.value.bones:
            assert group_of_bone(bone) is group
            assert group_of_bone(PARENTS[bone] or "hips") in (group, group.parent)
    assert group_of_bone("leftFoot") is DofGroup.ROOT


@pytest.mark.parametrize("group", LOCAL_GROUPS)
def test_the_resting_body_is_within_the_limits(group: DofGroup) -> None:
    rest = np.zeros((1, group.size))
    assert np.array_equal(clamp(group, rest), rest)
    assert (limits(group)[:, 0] < limits(group)[:, 1]).all()
    assert group.value.turning is not Turning.COLUMN or len(group.value.shares) == len(group.value.bones)


@pytest.mark.parametrize("group", LOCAL_GROUPS)
def test_a_group_moves_its_own_capsules_and_those_of_the_groups_on_it(group: DofGroup) -> None:
    humanoid = proportional_humanoid()
    model = body_model(humanoid)
    q, root = np.zeros((2, DOF)), np.zeros((2, 7))
    q[1, group.at] = clamp(group, 0.3 * np.ones(group.size))
    posed = posture_capsules(model, q, root)
    moved = np.flatnonzero(np.abs(posed[:, :, 1] - posed[:, :, 0]).max(axis=1) > 1e-4)
    carried = [other for other in DofGroup if group in (other, other.parent)]
    if group is DofGroup.WAIST:
        carried.append(DofGroup.ROOT)  # it lowers the hips
    assert {humanoid.capsules.groups[capsule] for capsule in moved} <= set(carried)
    assert set(model.capsules_of(group).indices) <= set(moved)
    assert len(group_capsules(model, group, q[:, group.at])) == len(model.capsules_of(group).indices)
