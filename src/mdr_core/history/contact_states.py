"""States of many contacts of one profile, for discrete elements, and one step of all of them."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from mdr_core.errors import InputError
from mdr_core.history import slip_memory
from mdr_core.history.contact_state import ContactState
from mdr_core.history.slip_layout import NORMAL
from mdr_core.history.slip_memory import Polyline, VertexTree
from mdr_core.history.step_results import TractionVertices
from mdr_core.interval_moments import interval_moments
from mdr_core.typing import Array, Indices
from mdr_core.validation import as_numbers, require_finite, require_inside, require_type


class Polylines(NamedTuple):
    """Polylines of many contacts."""

    vertices: Array
    """Vertices of all polylines, one after another, with the columns of `slip_layout`."""
    ends: Indices
    """End of each polyline among the vertices, shape (n,)."""
    load_points: Array
    """Normal and tangential coordinate of each contact, shape (2, n)."""

    def line(self, index: int) -> Polyline:
        """Return one polyline."""
        begin = self.ends[index - 1] if index else 0
        rows = self.vertices[begin : self.ends[index]]
        return Polyline(rows, *self.load_points[:, index].tolist())


@dataclass(frozen=True, repr=False, eq=False)
class ContactStates:
    """States of many contacts of one profile; indexing returns a `ContactState`."""

    contact: ContactState
    """Profile, moduli and coefficient of friction of all contacts."""
    polylines: Polylines
    """Slip memory of each contact."""
    before: Polylines | None = None
    """Slip memory before the step that led here."""

    def __len__(self) -> int:
        return self.polylines.ends.size

    def __getitem__(self, index: int) -> ContactState:
        at = range(len(self))[index]
        before, line = self.before and self.before.line(at), self.polylines.line(at)
        return replace(self.contact, polyline=line, before=before)

    @cached_property
    def _edges(self) -> TractionVertices:
        vertices, ends, load_points = self.polylines
        begins = np.append(0, ends[:-1])
        parent = np.arange(-1, len(vertices) - 1, dtype=np.intp)
        parent[begins[begins < ends]] = -1
        top, rows = np.where(begins < ends, ends - 1, -1), vertices[:, NORMAL:].T
        tree = VertexTree(parent, rows, top, (-1, 0.0, 0.0), load_points)
        return TractionVertices(interval_moments(self.contact.profile, over_forces=False), tree)

    @property
    def normal_force(self) -> Array:
        """F_N of each contact [force]."""
        edges = self._edges
        return self.contact.e_star * edges.tree.at_load_points(edges.conjugate)

    @property
    def tangential_force(self) -> Array:
        """F_x of each contact [force]."""
        edges, limit = self._edges, self.contact.friction_coefficient * self.contact.e_star
        return limit * edges.tree.at_load_points(edges.shear)


def advance_many(
    states: ContactState | ContactStates,
    indentation_depth: ArrayLike,
    tangential_displacement: ArrayLike,
) -> ContactStates:
    """Return the exact states of many contacts after one straight step of each.

    Each contact has the results of `advance`, in at most a tenth of its time.

    Source: mdr-5, Eqs. (5.4)-(5.9); notes, §10.

    Parameters
    ----------
    states : states from an earlier step, or one state, as from `unloaded`, for all contacts.
    indentation_depth : d of each contact after the step [length], shape (n,); <= 0 in separation.
    tangential_displacement : u_x of each contact after the step [length], shape (n,).

    Returns
    -------
    The new states; the given ones are not changed.

    Raises
    ------
    InputError : numbers that are not finite, lengths that differ, or a depth beyond the end of the
        profile.

    Examples
    --------
    Cones at zero, half and full displacement at full slip: Eqs. (5.47), (5.49).

    >>> from mdr_core.history import unloaded
    >>> from mdr_core.profiles import Cone
    >>> states = advance_many(unloaded(Cone(0.1), 1.0, 1.0, 0.5), [2.0, 2.0, 2.0], 0.0)
    >>> states = advance_many(states, 2.0, [0.0, 0.5, 1.0])
    >>> (states.tangential_force / (0.5 * states.normal_force)).round(12).tolist()
    [0.0, 0.75, 1.0]
    """
    needed = "the states from advance_many, or one state, as from history.unloaded"
    require_type("states", states, ContactState | ContactStates, needed)
    given = (
        ("indentation_depth", indentation_depth),
        ("tangential_displacement", tangential_displacement),
    )
    loads = {name: as_numbers((name,), values) for name, values in given}
    if isinstance(states, ContactState):
        sizes = [values.size for values in loads.values() if np.ndim(values)]
        states = _repeated(states, sizes[0] if sizes else 1)
    contact, last, count = states.contact, states.polylines, len(states)
    path = np.vstack([last.load_points, np.empty((2, count))])
    for row, (name, values) in zip(path[2:], loads.items(), strict=True):
        if np.shape(values) not in {(), (count,)}:
            raise InputError((name,), f"must be one number, or one for each of {count} contacts")
        require_finite((name,), values)
        row[:] = values
    profile, largest = contact.profile, contact.profile.largest_loads
    if largest is not None:
        require_inside(("indentation_depth",), path[2] > largest[0], profile.domain)
    path[3] /= contact.displacement_ratio
    moved = slip_memory.moved_each(last.vertices, last.ends, path)
    return ContactStates(contact, Polylines(*moved, path[2:]), last)


def _repeated(state: ContactState, count: int) -> ContactStates:
    """Return copies of one state for several contacts."""
    vertices, *load_point = state.polyline
    ends = len(vertices) * np.arange(1, count + 1)
    load_points = np.tile(load_point, (count, 1)).T
    return ContactStates(state, Polylines(np.tile(vertices, (count, 1)), ends, load_points))
