"""What the report and the figure of a fit tell."""

import numpy as np
import pytest

from spavision.model.fitting.figures import fit_figure
from spavision.model.fitting.fit import fit_all, fit_law
from spavision.model.fitting.report import fit_report
from spavision.model.materials.mooney_rivlin import MooneyRivlin
from spavision.model.materials.ogden import Ogden

from .curves import synthetic


@pytest.fixture(scope="module")
def curves():
    return synthetic(MooneyRivlin(0.05, 0.01), points=20, noise=0.01)


def test_report_holds_every_number_of_the_fit(curves):
    fit = fit_law("mooney2", curves)
    report = fit_report(fit)
    for parameter in fit.parameters:
        assert f"{parameter.value:.6g} ± {parameter.standard_error:.2g} MPa" in report
    assert f"R² {fit.goodness.r_squared:.5f}" in report
    assert f"C01, C10: {fit.correlation[0, 1]:+.3f}" in report
    for mode in ("uniaxial", "equibiaxial", "planar"):
        assert f"{mode}: stretch" in report
        assert f"({mode}, 20 points)" in report


def test_report_gives_ogden_moduli_in_each_convention():
    """0.131 and 0.003 with exponents 2 and 6 are 0.131 and 0.009 in Abaqus' convention (closed-forms.md)."""
    report = fit_report(fit_law("ogden2", synthetic(Ogden((0.131, 0.003), (2.0, 6.0)))))
    (abaqus,) = (line for line in report.splitlines() if "Abaqus" in line)
    moduli = abaqus.split("2mu/alpha^2")[1].split("(")[0]
    np.testing.assert_allclose([float(text) for text in moduli.split(",")], [0.131, 0.009], rtol=1e-3)


def test_figure_has_a_panel_for_each_mode_and_at_most_four_laws(curves):
    figure = fit_figure(fit_all(curves).fits)
    assert [axes.get_title() for axes in figure.axes] == ["uniaxial", "equibiaxial", "planar"]
    for axes in figure.axes:
        assert len(axes.lines) == 1 + 4
