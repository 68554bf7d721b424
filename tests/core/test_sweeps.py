"""Sweeps over many scenes: block by block they say what one scene after the other does."""

from typing import Any

import numpy as np
import pytest

from mdr_core import normal
from mdr_core.errors import InputError
from mdr_core.profiles import (
    Paraboloid,
    Profile,
)
from mdr_core.sweeps import BLOCK, in_blocks
from mdr_core.typing import Array

MANY = 2 * BLOCK + 7
E_STAR = 1.1e11


def test_answers_of_blocks_are_those_of_the_whole() -> None:
    R, moduli = np.linspace(1.0, 2.0, MANY), np.linspace(3.0, 4.0, MANY)

    def solve(profile: Any, e_star: Array, load: float) -> tuple[Array, Array]:
        return profile.radius * load / e_star, np.asarray(load)

    quotient, load = in_blocks(solve, Paraboloid(R), (moduli, 5.0))
    assert np.array_equal(quotient, R * 5.0 / moduli)
    assert load.ndim == 0
    assert load == 5.0


def test_a_number_that_changes_from_block_to_block_becomes_an_array() -> None:
    values = np.arange(float(MANY))

    def least(_profile: Profile, part: Array) -> tuple[Array]:
        return (np.asarray(part.min() // BLOCK),)

    (found,) = in_blocks(least, Paraboloid(1.0), (values,))
    assert np.array_equal(found, values // BLOCK)


def test_a_grid_of_parameters_is_swept_like_its_flat_copy() -> None:
    R, force = np.linspace(0.01, 0.02, 300)[:, None], np.linspace(1.0, 2.0, 400)[None, :]
    grid = normal.solve(Paraboloid(R), E_STAR, normal_force=force)
    flat_R, flat_force = (part.ravel() for part in np.broadcast_arrays(R, force))
    flat = normal.solve(Paraboloid(flat_R), E_STAR, normal_force=flat_force)
    assert grid.contact_radius.shape == (300, 400)
    assert np.array_equal(grid.contact_radius.ravel(), flat.contact_radius)
    assert np.array_equal(grid.indentation_depth.ravel(), flat.indentation_depth)


@pytest.mark.parametrize("wrong", [-1.0, np.nan, np.inf])
@pytest.mark.parametrize("control", ["normal_force", "indentation_depth", "contact_radius"])
def test_a_wrong_load_is_named_by_its_place_in_the_sweep(control: str, wrong: float) -> None:
    loads = np.full(MANY, 1e-3)
    loads[BLOCK + 5] = wrong
    given: dict[str, Any] = {control: loads}
    with pytest.raises(InputError) as refused:
        normal.solve(Paraboloid(np.full(MANY, 0.01)), E_STAR, **given)
    assert refused.value.path == ("load", control, BLOCK + 5)


@pytest.mark.parametrize("load", [0.0, 1.0])
@pytest.mark.parametrize("wrong", [-1.0, 0.0, np.nan, np.inf])
@pytest.mark.parametrize("control", ["normal_force", "indentation_depth"])
def test_a_wrong_modulus_is_refused_in_a_sweep(control: str, wrong: float, load: float) -> None:
    moduli, loads = np.full(MANY, E_STAR), np.full(MANY, load)
    moduli[BLOCK + 5] = wrong
    given: dict[str, Any] = {control: loads}
    with pytest.raises(InputError) as refused:
        normal.solve(Paraboloid(0.01), moduli, **given)
    assert refused.value.path == ("material", "e_star")
