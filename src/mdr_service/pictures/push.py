"""Force over displacement of a contact that is loaded once."""

import numpy as np

from mdr_core.tangential import TangentialContact
from mdr_service.pictures import canvas
from mdr_service.solve import travel_to_full_slip


def tangential(contact: TangentialContact) -> bytes:
    """Return force over displacement up to full slip, for the first normal load."""
    travel = travel_to_full_slip(contact)
    forces, displacements = (
        np.ravel(contact.tangential_force),
        np.ravel(contact.tangential_displacement),
    )
    normal_forces = np.broadcast_to(np.ravel(contact.normal.normal_force), forces.shape)
    answered = normal_forces == normal_forces[0]
    end = max(displacements[answered].max(), -displacements[answered].min())
    x = np.append(travel.tangential_displacement, max(end, travel.tangential_displacement[-1]))
    y = np.append(travel.tangential_force, travel.tangential_force[-1])
    with canvas.drawing():
        figure, (axes,) = canvas.panels(1)
        for sign in (1, -1) if displacements[answered].min() < 0 else (1,):
            axes.plot(sign * x, sign * y, color="C0")
            axes.axhline(sign * y[-1], color="0.5", linestyle=":", linewidth=0.8)
        axes.plot(displacements[answered], forces[answered], "o", color="C1", label="answered")
        axes.annotate(
            r"$\mu F_N$", (0, y[-1]), xytext=(3, 3), textcoords="offset points", color="0.4"
        )
        axes.set_xlabel(f"tangential displacement $u_x$   ({canvas.UNITS})")
        axes.set_ylabel("tangential force $F_x$")
        axes.set_title(f"$F_N$ = {normal_forces[0]:.6g}", fontsize="medium")
        axes.legend(loc="lower right")
        return canvas.written(figure)
