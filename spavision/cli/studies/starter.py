"""``spavision study starter``: a study file to start from."""

from __future__ import annotations

import click

STARTER = """\
# A study of the article's suspects. Run it with
#   spavision study tolerance study.toml
# Any number or material under [actuator], [composite], [gauge] of the experiment file can be a suspect, and
# law, standoff_mm, distance_mm, scale. Its nominal value is the experiment file's, or the default.

[study]
# experiment = "experiment.toml"
crimp_ratio = 0.2
model = "reduced"              # about 1 s a case; "full" takes about 8
cases = 128                    # a power of two suits the Sobol sequence
pressures_kPa = [0, 5, 10, 15, 20, 25, 30, 35, 40, 45, 50]

# Printed moulds: +-0.2 to +-0.5 mm, of which +-0.1 mm matters already (article).
[suspects.wall_between_voids_mm]
distribution = "uniform"
plus_minus = 0.2
[suspects.side_wall_mm]
distribution = "uniform"
plus_minus = 0.2
[suspects.roof_mm]
distribution = "uniform"
plus_minus = 0.2
[suspects.strip_a_mm]          # closes the voids; void_floor_mm is one where the mould casts a floor
distribution = "uniform"
plus_minus = 0.1
[suspects.strip_b_mm]
distribution = "uniform"
plus_minus = 0.2
[suspects.composite_mm]
distribution = "uniform"
plus_minus = 0.2

# Silicones: scatter from batch to batch (assumed), and sources that disagree.
[suspects.body_stiffness]
distribution = "normal"
sigma = 0.1
[suspects.matrix_material]
distribution = "choice"        # the library's alternatives; or options = ["...", "..."]
[suspects.bulk_to_shear]
distribution = "uniform"
low = 200
high = 2000

# Composite: all assumed but the transition at crimp ratio 0.3.
[suspects.paper_transition_factor]
distribution = "triangular"
plus_minus = 0.1
[suspects.paper_transition_half_width]
distribution = "uniform"
low = 0.05
high = 0.15
[suspects.paper_length_modulus_MPa]
distribution = "uniform"
low = 5
high = 40
[suspects.paper_width_modulus_MPa]
distribution = "uniform"
low = 0
high = 20

# The composite's law, for attribute; tolerance keeps the nominal one, for a form of the model has no scatter.
# With the other two, which a virtual coupon calibrates, the paper's figures above have no effect.
[suspects.law]
distribution = "choice"
options = ["slack-fibre", "resolved", "ogden"]

# The gauge. A dial of class 2.5 (EN 837-1) may be off by 2.5 % of its span anywhere: by 2.5 kPa on one of
# 100 kPa, by 10 kPa on one of 400 kPa. The article names none: put your own here. 5 % is assumed.
[suspects.pressure_offset_kPa]
distribution = "uniform"
plus_minus = 2.5
[suspects.pressure_scale]      # true over read pressure
distribution = "normal"
sigma = 0.05

# Set-up.
[suspects.gravity_tilt_deg]
distribution = "normal"
sigma = 2
[suspects.standoff_mm]         # moves the measured path, not the model
distribution = "normal"
mean = 20
sigma = 1

# For attribute and update: the path to explain; further ones check what update fits to the first.
# [[measured]]
# path = "track.csv"
# crimp_ratio = 0.2

# For update: the parameters to fit, of those above.
# [update]
# parameters = ["body_stiffness", "paper_transition_factor"]

# For design: a wish, and what there is to choose from.
# [design]
# mode_change_kPa = 45
# crimp_ratios = [0.15, 0.2, 0.25, 0.3, 0.35]
# strips_mm = [0, 1, 2, 3]      # 0: none
# strip_materials = ["Mold Star 15 two-term", "Smooth-Sil 950"]

# For sweep: every combination of these values.
# [grid]
# crimp_ratio = [0.2, 0.25, 0.3]
# strip_b_mm = [1, 2, 3]
"""


@click.command()
def starter() -> None:
    """Print a study file to start from: every suspect that the article names."""
    click.echo(STARTER, nl=False)
