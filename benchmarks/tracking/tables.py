"""Tables of the tracker's benchmark: rows saved set by set, and the page that is made of them.

Run: python benchmarks/tracking/tables.py (writes the page into docs/tracking.md)
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
from scenes import NUISANCES

RESULTS = Path(__file__).parent / "measured"
GUIDE = Path(__file__).parents[2] / "docs" / "tracking.md"
START, END = "<!-- benchmark: start -->", "<!-- benchmark: end -->"
KEYS = ["set", "seed", "detector"]


def save_rows(path: Path, rows: list[dict[str, object]]) -> None:
    """Put rows into a table, in place of older ones of the same set, seed and detector."""
    table = pd.DataFrame(rows)
    keys = [key for key in KEYS if key in table]
    if path.exists():
        table = pd.concat([pd.read_csv(path), table]).drop_duplicates(keys, keep="last")
    order = {name: place for place, name in enumerate(NUISANCES)}
    table = table.sort_values(
        ["seed", "set"], key=lambda c: c.map(order) if c.name == "set" else c, kind="stable"
    )
    table.to_csv(path, index=False)


def page(folder: Path) -> str:
    """Return the saved tables as Markdown, with what they say in all."""
    parts = []
    tracker = pd.read_csv(folder / "tracker.csv") if (folder / "tracker.csv").exists() else None
    if tracker is not None:
        first = tracker["seed"] == 1
        parts += [f"**Seed 1.** {_overall(tracker[first])}", _markdown(tracker[first].drop(columns="seed"))]
        if not first.all():
            parts += [f"**Other seeds, held out.** {_overall(tracker[~first])}", _markdown(tracker[~first])]
    if (folder / "peers.csv").exists():
        peers = pd.read_csv(folder / "peers.csv")
        title = (
            f"**Peers**, on the first photo of {peers['set'].nunique()} sets (spavision: all photos of them)."
        )
        parts += [title, _markdown(_peer_summary(peers, tracker))]
    if (folder / "memory.csv").exists():
        parts += ["**Large photographs.**", _markdown(pd.read_csv(folder / "memory.csv"))]
    return "\n\n".join(parts)


def update_guide() -> None:
    """Write the page into the guide, between its two marks."""
    text = GUIDE.read_text(encoding="utf-8")
    before, rest = text.split(START)
    GUIDE.write_text(f"{before}{START}\n\n{page(RESULTS)}\n\n{END}{rest.split(END)[1]}", encoding="utf-8")


def _overall(table: pd.DataFrame) -> str:
    holds = np.average(table["95 % holds"], weights=table["readings"])
    return (
        f"{len(table)} sets, {table['readings'].sum()} readings: "
        f"{table['lost'].sum()} lost, {table['false'].sum()} false, {table['wrong'].sum()} corners wrongly "
        f"indexed; {(table['within'] == 'yes').sum()} of {len(table)} sets within their limits; "
        f"the 95 % interval holds the truth in {100 * holds:.1f} %."
    )


def _peer_summary(peers: pd.DataFrame, tracker: pd.DataFrame | None) -> pd.DataFrame:
    """One line a detector over the sets: share of photos read, corners, rms, wrong ones, time."""
    lines = []
    if tracker is not None:
        own = tracker.merge(peers[["set", "seed"]].drop_duplicates())
        rms = np.sqrt(np.average(own["corner rms px"] ** 2, weights=own["corners"]))
        read = own["read"].str.split("/", expand=True).astype(int).sum()
        lines.append(
            _peer_line("spavision", f"{read[0]}/{read[1]}", own["corners"], rms, own["wrong"], own["s/MP"])
        )
    for name, group in peers.groupby("detector", sort=False):
        rms = np.sqrt(group["square error px2"].sum() / max(group["right"].sum(), 1))
        read = f"{int((group['corners'] > 0).sum())}/{len(group)}"
        lines.append(_peer_line(str(name), read, group["corners"], rms, group["wrong"], group["s/MP"]))
    return pd.DataFrame(lines)


def _peer_line(
    name: str, read: str, corners: pd.Series, rms_px: float, wrong: pd.Series, seconds: pd.Series
) -> dict[str, object]:
    return {
        "detector": name,
        "photos read": read,
        "corners a photo": int(corners.mean()),
        "corner rms px": round(float(rms_px), 3) if corners.sum() else "",
        "wrong": int(wrong.sum()),
        "s/MP": round(float(seconds.mean()), 2),
    }


def _markdown(table: pd.DataFrame) -> str:
    lines = ["| " + " | ".join(map(str, table.columns)) + " |", "|" + "---|" * len(table.columns)]
    lines += ["| " + " | ".join(map(str, row)) + " |" for row in table.itertuples(index=False)]
    return "\n".join(lines)


if __name__ == "__main__":
    update_guide()
