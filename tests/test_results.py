"""The results folder: whole files, nothing lost, an earlier run's files replaced only when asked."""

import hashlib
import json

import pytest

from spavision.errors import InputError
from spavision.results import ResultsFolder, sha256


def test_an_interrupted_file_leaves_nothing(tmp_path):
    results = ResultsFolder(tmp_path / "run")

    def fail_half_way(path):
        path.write_text("half")
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        results.write("track.csv", fail_half_way)
    assert not list((tmp_path / "run").iterdir())


def test_a_folder_in_use_is_refused_and_untouched(tmp_path):
    (tmp_path / "mine.txt").write_text("mine")
    with pytest.raises(InputError, match="--force"):
        ResultsFolder(tmp_path)
    assert (tmp_path / "mine.txt").read_text() == "mine"


def test_force_replaces_the_earlier_run_and_keeps_the_user_s_files(tmp_path):
    first = ResultsFolder(tmp_path / "run")
    first.write_text("overlays/old.txt", "old")
    first.write_record({"command": "test"})
    (tmp_path / "run" / "corrections.csv").write_text("mine")
    second = ResultsFolder(tmp_path / "run", force=True)
    second.write_text("track.csv", "new")
    second.write_record({"command": "test"})
    kept = {path.name for path in (tmp_path / "run").rglob("*") if path.is_file()}
    assert kept == {"corrections.csv", "track.csv", "run.json"}


def test_the_record_lists_versions_and_files(tmp_path):
    results = ResultsFolder(tmp_path / "run")
    results.write_text("track.csv", "a")
    record = json.loads(results.write_record({"command": "test"}).read_text())
    assert record["files"] == ["run.json", "track.csv"]
    assert {"python", "numpy", "spavision"} <= set(record["versions"])


def test_a_record_cannot_make_a_later_run_delete_outside_its_folder(tmp_path):
    (tmp_path / "outside.txt").write_text("keep")
    (tmp_path / "run").mkdir()
    (tmp_path / "run" / "run.json").write_text(json.dumps({"files": ["../outside.txt"]}))
    ResultsFolder(tmp_path / "run", force=True).write_text("track.csv", "a")
    assert (tmp_path / "outside.txt").read_text() == "keep"


def test_a_file_or_an_unwritable_place_is_told(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="is a file"):
        ResultsFolder(tmp_path / "file")
    with pytest.raises(InputError, match="cannot be written to"):
        ResultsFolder(tmp_path / "file" / "below")
    with pytest.raises(InputError, match="cannot be written to"):
        ResultsFolder(type(tmp_path)("/proc/spavision"))


def test_digest_is_the_published_one(tmp_path):
    path = tmp_path / "abc.txt"
    path.write_bytes(b"abc")
    # FIPS 180-2, appendix B.1.
    expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
    assert sha256(path) == expected


def test_the_record_holds_the_digest_of_each_input(tmp_path):
    for folder in ("first", "second"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "tension.csv").write_text(folder)
    (tmp_path / "experiment.toml").write_text("")
    results = ResultsFolder(tmp_path / "run")
    results.record_inputs([tmp_path / "first" / "tension.csv", tmp_path / "experiment.toml"])
    results.record_inputs([tmp_path / "second" / "tension.csv"])
    inputs = json.loads(results.write_record({}).read_text())["inputs"]
    assert inputs["experiment.toml"] == hashlib.sha256(b"").hexdigest()
    # Two files of one name are told apart by their folders.
    assert {digest for name, digest in inputs.items() if name.endswith("tension.csv")} == {
        hashlib.sha256(folder.encode()).hexdigest() for folder in ("first", "second")
    }


def test_an_input_that_cannot_be_read_is_refused(tmp_path):
    with pytest.raises(InputError, match="cannot be read"):
        ResultsFolder(tmp_path / "run").record_inputs([tmp_path / "photo.jpg"])
