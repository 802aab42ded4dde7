"""Geometrically exact beam elements in the plane (Reissner 1972, Simo 1985) for the paper."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from spavision.model.elements import FloatArray, IntArray

from .paper import Paper
from .quadratic import gauss_rule, line_shapes


@dataclass(frozen=True)
class BeamResponse:
    """Forces and tangents of all beam elements, and the section forces in them.

    An element's ten unknowns are x, y and rotation of its first, middle and last node, and the strain
    along z.

    Parameters
    ----------
    forces : array, shape (n_elements, 10)
        In N and N mm per unit width.
    tangents : array, shape (n_elements, 10, 10)
    tension : array, shape (n_elements, n_points)
        Along the beam, in N/mm.
    curvature : array, shape (n_elements, n_points)
        Change of curvature in 1/mm.
    """

    forces: FloatArray
    tangents: FloatArray
    tension: FloatArray
    curvature: FloatArray


class Beam:
    """Quadratic beam elements along a line of nodes, integrated at two points, which avoids locking.

    With x′ the deformed position's slope along the undeformed line, and t, n the undeformed tangent and
    normal turned by the section's rotation θ, the strains are x′·t − 1, x′·n and θ′. The line may be
    curved or kinked: the rotation is counted from the undeformed shape.

    Parameters
    ----------
    points_mm : array, shape (2·n_elements + 1, 2)
        Ends and middles of the elements.
    paper : Paper

    References
    ----------
    E. Reissner, J. Appl. Math. Phys. (ZAMP) 23 (1972) 795-804. J. C. Simo, Comput. Methods Appl. Mech. Eng.
    49 (1985) 55-70.
    """

    def __init__(self, points_mm: FloatArray, paper: Paper) -> None:
        self.paper = paper
        self.nodes: IntArray = np.arange(0, len(points_mm) - 2, 2)[:, None] + np.arange(3)
        place, weight = gauss_rule(2)
        values, slopes = line_shapes(place)
        along = np.einsum("qa,eai->eqi", slopes, points_mm[self.nodes])
        stretch = np.linalg.norm(along, axis=2)
        self._values = values
        self._slopes = slopes[None] / stretch[..., None]
        self._tangent = along / stretch[..., None]
        self.lengths_mm: FloatArray = stretch * weight

    def respond(self, displacement: FloatArray, rotation: FloatArray, cross_strain: float) -> BeamResponse:
        """Evaluate forces and tangents.

        Parameters
        ----------
        displacement : array, shape (n_points, 2)
            Of the line's nodes, in mm.
        rotation : array, shape (n_points,)
            In rad.
        cross_strain : float
            Engineering strain along z.
        """
        strain, frame, place_slope = self._strains(displacement, rotation)
        resultant, stiffness = self._section(strain, cross_strain)
        operator = self._operator(strain, frame)
        forces = np.einsum("eq,eqs,eqsd->ed", self.lengths_mm, resultant, operator)
        tangents = np.einsum(
            "eq,eqsd,eqst,eqtf->edf", self.lengths_mm, operator, stiffness, operator, optimize=True
        )
        tangents += self._geometric(resultant, frame, place_slope)
        return BeamResponse(forces, tangents, resultant[..., 0], strain[..., 2])

    def energy(self, displacement: FloatArray, rotation: FloatArray, cross_strain: float) -> float:
        """Return the strain energy, in N mm per mm width."""
        strain, _, _ = self._strains(displacement, rotation)
        membrane = self.paper.membrane
        pair = np.stack([strain[..., 0], np.full(strain.shape[:2], cross_strain)], axis=2)
        density = 0.5 * np.einsum("eqi,ij,eqj->eq", pair, membrane, pair)
        density += 0.5 * self.paper.shear_stiffness * strain[..., 1] ** 2
        density += self.paper.bending_energy(strain[..., 2])
        return float(np.sum(self.lengths_mm * density))

    def _strains(
        self, displacement: FloatArray, rotation: FloatArray
    ) -> tuple[FloatArray, tuple[FloatArray, FloatArray], FloatArray]:
        """Stretching, shear and curvature, (n, q, 3); the turned tangent and normal; the deformed slope."""
        angle = np.einsum("qa,ea->eq", self._values, rotation[self.nodes])
        bend = np.einsum("eqa,ea->eq", self._slopes, rotation[self.nodes])
        slope = self._tangent + np.einsum("eqa,eai->eqi", self._slopes, displacement[self.nodes])
        cosine, sine = np.cos(angle), np.sin(angle)
        x, y = self._tangent[..., 0], self._tangent[..., 1]
        tangent = np.stack([cosine * x - sine * y, sine * x + cosine * y], axis=2)
        normal = np.stack([-tangent[..., 1], tangent[..., 0]], axis=2)
        strain = np.stack([(slope * tangent).sum(axis=2) - 1.0, (slope * normal).sum(axis=2), bend], axis=2)
        return strain, (tangent, normal), slope

    def _section(self, strain: FloatArray, cross_strain: float) -> tuple[FloatArray, FloatArray]:
        """Tension, shear force, moment and cross force, (n, q, 4), and their slopes, (n, q, 4, 4)."""
        membrane, paper = self.paper.membrane, self.paper
        moment, bending = paper.moment(strain[..., 2])
        resultant = np.stack(
            [
                membrane[0, 0] * strain[..., 0] + membrane[0, 1] * cross_strain,
                paper.shear_stiffness * strain[..., 1],
                moment,
                membrane[1, 0] * strain[..., 0] + membrane[1, 1] * cross_strain,
            ],
            axis=2,
        )
        stiffness = np.zeros((*strain.shape[:2], 4, 4))
        stiffness[..., 0, 0], stiffness[..., 3, 3] = membrane[0, 0], membrane[1, 1]
        stiffness[..., 0, 3] = stiffness[..., 3, 0] = membrane[0, 1]
        stiffness[..., 1, 1] = paper.shear_stiffness
        stiffness[..., 2, 2] = bending
        return resultant, stiffness

    def _operator(self, strain: FloatArray, frame: tuple[FloatArray, FloatArray]) -> FloatArray:
        """First derivatives of the four strains in the ten unknowns, (n, q, 4, 10)."""
        tangent, normal = frame
        operator = np.zeros((*strain.shape[:2], 4, 10))
        for node in range(3):
            slope, value = self._slopes[..., node], self._values[:, node]
            first = 3 * node
            operator[..., 0, first : first + 2] = slope[..., None] * tangent
            operator[..., 1, first : first + 2] = slope[..., None] * normal
            operator[..., 0, first + 2] = strain[..., 1] * value
            operator[..., 1, first + 2] = -(1.0 + strain[..., 0]) * value
            operator[..., 2, first + 2] = slope
        operator[..., 3, 9] = 1.0
        return operator

    def _geometric(
        self, resultant: FloatArray, frame: tuple[FloatArray, FloatArray], place_slope: FloatArray
    ) -> FloatArray:
        """Second derivatives of the strains, weighted by the section forces, (n, 10, 10)."""
        tangent, normal = frame
        tension, shear = resultant[..., 0], resultant[..., 1]
        mixed = tension[..., None] * normal - shear[..., None] * tangent
        turning = -tension * (place_slope * tangent).sum(axis=2) - shear * (place_slope * normal).sum(axis=2)
        out = np.zeros((len(self.nodes), 10, 10))
        for a in range(3):
            for b in range(3):
                weight = self.lengths_mm * self._values[:, b]
                cross = np.einsum("eq,eq,eqi->ei", weight, self._slopes[..., a], mixed)
                out[:, 3 * a : 3 * a + 2, 3 * b + 2] += cross
                out[:, 3 * b + 2, 3 * a : 3 * a + 2] += cross
                out[:, 3 * a + 2, 3 * b + 2] += np.sum(weight * self._values[:, a] * turning, axis=1)
        return out
