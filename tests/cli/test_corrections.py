"""``corrections.csv`` beside the photos, and ``--strict``."""

import json

import pandas as pd
import pytest

from .conftest import A_FEW, SAMPLES

PIXEL = next(
    photo["dot_px"]
    for photo in json.loads((SAMPLES / "crimp-0.20" / "truth.json").read_text())["photos"]
    if photo["photo"] == A_FEW[1]
)


def test_corrections_are_honoured_marked_and_left_alone_and_strict_tells_them(spavision, photos, tmp_path):
    file = photos / "corrections.csv"
    text = (
        "photo,x_px,y_px,reject,note\n"
        f"{A_FEW[1]},{PIXEL[0] + 2},{PIXEL[1]},,from the print\n"
        f'{A_FEW[2]},,,yes,"tube was kinked, valve open"\n'
    )
    file.write_text(text)
    outcome = spavision("track", photos, "-o", "out", "--strict")
    assert outcome.code == 3
    assert outcome.err.count("\n") == 1
    assert f"1 of 3 photos are not ok: {A_FEW[2]} (rejected)" in outcome.err
    table = pd.read_csv(tmp_path / "out" / "track.csv")
    assert table["status"].tolist() == ["ok", "ok", "rejected"]
    assert table["reason"].tolist()[1:] == [
        "marker given by hand: from the print",
        "tube was kinked, valve open",
    ]
    assert "rejected: tube was kinked" in outcome.out
    assert len(list((tmp_path / "out" / "overlays").iterdir())) == 3
    assert "corrections.csv" in json.loads((tmp_path / "out" / "run.json").read_text())["inputs"]
    assert file.read_text() == text


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        ("photo,x_px,y_px\nother.jpg,10,10\n", ("other.jpg", "not among")),
        (f"photo,x_px,y_px,reject\n{A_FEW[0]},10,10,yes\n", ("row 2", A_FEW[0], "either")),
        (f"photo,x_px,y_px,reject\n{A_FEW[0]},,,\n", ("row 2", "either")),
        (f"photo,x_px,y_px,reject\n{A_FEW[0]},10,,\n", ("row 2", "either")),
        (f"photo,x_px,y_px\n{A_FEW[0]},ten,10\n", ("x_px in row 2", "'ten'", "number")),
        (f"photo,reject\n{A_FEW[0]},perhaps\n", ("reject in row 2", "'perhaps'")),
        (f"photo,reject\n{A_FEW[0]},yes\n{A_FEW[0]},yes\n", ("row 3", "repeats")),
        (f"photo,x,y\n{A_FEW[0]},10,10\n", ("unknown column x", "x_px")),
        ("x_px,y_px\n10,10\n", ("column photo is missing",)),
    ],
)
def test_a_bad_corrections_file_is_refused(spavision, photos, rows, words):
    (photos / "corrections.csv").write_text(rows)
    assert spavision("track", photos).is_one_sentence_about("corrections", *words)


def test_the_word_reject_serves_in_the_place_of_a_pixel(tmp_path):
    from spavision.workflow.corrections_file import read_corrections

    path = tmp_path / "corrections.csv"
    path.write_text("photo,x_px,y_px,note\na.jpg,reject,,blurred\nb.jpg,1.5,2,\n")
    corrections = read_corrections(path)
    assert corrections["a.jpg"].pixel is None
    assert corrections["a.jpg"].remark == "blurred"
    assert corrections["b.jpg"].pixel == (1.5, 2.0)
