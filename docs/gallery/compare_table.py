"""Compare a path that was measured otherwise, a table, with the model."""

from pathlib import Path

from spavision import compare, simulate

Path("measured.csv").write_text("pressure_kPa,ux_mm,uy_mm\n0,0,0\n10,0.5,0.4\n20,1.1,0.9\n")

simulated = simulate(
    actuator={"crimp_ratio": 0.2, "void_count": 4}, model={"mesh": "draft"}, pressures_kPa=(0, 10, 20)
)
compared = compare("measured.csv", simulated)

print(compared.table())
print(*compared.sentences(), sep="\n")
compared.plot().savefig("paths.svg")
compared.save("results/compared", formats=("html", "md"))
