"""Model an actuator of one's own: four voids, a stiffer strip, and walls thick or thin."""

from spavision import simulate

shape = {"crimp_ratio": 0.25, "void_count": 4, "strip_b_mm": 2.0, "strip_b_material": "Smooth-Sil 950"}
pressures_kPa = (0, 10, 20)

thick = simulate(
    actuator=shape | {"side_wall_mm": 3.0, "wall_between_voids_mm": 3.0},
    model={"mesh": "draft"},
    pressures_kPa=pressures_kPa,
)
thin = simulate(
    actuator=shape | {"side_wall_mm": 2.0, "wall_between_voids_mm": 2.0},
    model={"mesh": "draft"},
    pressures_kPa=pressures_kPa,
)
print(f"thick walls: {thick.tip_path.ux_mm[-1]:.2f} mm at {pressures_kPa[-1]} kPa")
print(f"thin walls:  {thin.tip_path.ux_mm[-1]:.2f} mm at {pressures_kPa[-1]} kPa")
thick.plot().savefig("thick_walls.png")
