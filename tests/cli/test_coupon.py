"""``spavision coupon`` from options to results folder."""

import json

import meshio
import numpy as np
import pandas as pd
import pytest

QUICK = ("--crimp", "0.3", "--strain-step", "0.04")


def test_a_coupon_leaves_curve_figure_fields_and_record(spavision, tmp_path):
    outcome = spavision("coupon", *QUICK, "-o", "out")
    assert outcome.code == 0, outcome.err
    assert "published test: 38.8 %" in outcome.out
    assert "Assumed: wavelength" in outcome.out
    curve = pd.read_csv(tmp_path / "out" / "curve-planar.csv")
    assert curve["strain"][0] == 0.0
    assert np.all(np.diff(curve["nominal_stress_MPa"]) > 0.0)
    record = json.loads((tmp_path / "out" / "run.json").read_text(encoding="utf-8"))
    assert record["coupon"]["ended_by"] == "tear"
    assert {"curve-planar.csv", "figures/coupon.png", "fields/coupon_000.vtu"} <= set(record["files"])
    field = meshio.read(tmp_path / "out" / "fields" / "coupon_001.vtu")
    # half of the wave of 5 mm, pulled by 4 %
    assert field.point_data["displacement_mm"][:, 0].max() == pytest.approx(0.04 * 2.5)


def test_fit_takes_the_curve_as_it_is(spavision):
    assert spavision("coupon", *QUICK, "-q", "-o", "out").code == 0
    outcome = spavision("fit", "out/curve-planar.csv", "--law", "gent", "--json")
    assert outcome.code == 0, outcome.err
    result = json.loads(outcome.out)
    assert result["curves"][0]["mode"] == "planar"
    assert result["fits"][0]["r_squared"] > 0.8


def test_options_reach_the_coupon(spavision):
    """Without paper and with a free width: uniaxial tension of the matrix, no transition."""
    outcome = spavision(
        "coupon", *QUICK, "--paper-modulus-mpa", "0", "--lateral", "plane-stress", "--end-strain", "0.2",
        "--paper-yield-mpa", "inf",
        "--matrix", "Ecoflex 00-30, Marechal 2021", "--wavelength-mm", "4", "--thickness-mm", "3", "--json",
    )  # fmt: skip
    assert outcome.code == 0, outcome.err
    result = json.loads(outcome.out)
    assert (result["geometry"]["wavelength_mm"], result["geometry"]["thickness_mm"]) == (4.0, 3.0)
    assert result["paper"]["bending_yield_MPa"] == "inf"
    assert result["ended_by"] == "end strain"
    assert result["transition"] is None
    # Ogden of one term, μ (λ^(α−1) − λ^(−α/2−1)), μ = 0.0131834 MPa, α = 2.27526
    assert result["end_stress_MPa"] == pytest.approx(0.0131834 * (1.2**1.27526 - 1.2**-2.13763), rel=1e-3)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--crimp", "0.9"), ("crimp ratio", "0.9")),
        (("--crimp", "0.3", "--wavelength-mm", "20"), ("wavelength_mm", "does not fit")),
        (("--crimp", "0.3", "--fold-radius-mm", "-1"), ("fold_radius_mm",)),
        (("--crimp", "0.3", "--strain-step", "0"), ("strain step",)),
        (("--crimp", "0.3", "--end-strain", "50"), ("end strain",)),
        (("--crimp", "0.3", "--matrix", "Gold"), ("Gold", "Ecoflex 00-30")),
        (("--crimp", "0.3", "--paper", "Card"), ("Card", "Bond paper")),
        (("--crimp", "0.3", "--paper-modulus-mpa", "-5"), ("modulus_MPa",)),
        (("--crimp", "0.3", "--paper-thickness-mm", "3"), ("6 mm high", "thinner paper")),
    ],
)
def test_bad_options_are_refused(spavision, tmp_path, options, words):
    outcome = spavision("coupon", *options)
    assert outcome.is_one_sentence_about(*words), outcome.err
    assert not (tmp_path / "results").exists()
