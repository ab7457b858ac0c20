"""The parts of scripts/atlas and scripts/overhead that need no program that was built."""
import importlib.machinery
import importlib.util
import json
import sys
import tempfile
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
scripts = Path(__file__).resolve().parents[3] / "scripts"


def loaded(name):
    loader = importlib.machinery.SourceFileLoader(name, str(scripts / name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    loader.exec_module(module)
    return module


atlas, overhead = loaded("atlas"), loaded("overhead")


class Overhead(unittest.TestCase):
    def test_libraries_leave_out_those_of_the_system(self):
        listed = """\tlinux-vdso.so.1 (0x00007ffc)
\tlibumfpack.so.5 => /lib/libumfpack.so.5 (0x00007f)
\tlibblas.so.3 => /lib/libblas.so.3 (0x00007f)
\tlibstdc++.so.6 => /lib/libstdc++.so.6 (0x00007f)
\tlibc.so.6 => /lib/libc.so.6 (0x00007f)
\t/lib64/ld-linux-x86-64.so.2 (0x00007f)
"""
        self.assertEqual(overhead.libraries(listed), ["libblas", "libumfpack"])

    def test_profile_tells_shares_the_largest_first(self):
        summary = {"times": {"parts": [{"part": "move", "seconds": 1.0}, {"part": "pairs", "seconds": 3.0},
                                       {"part": "solids", "seconds": 0.001}]}}
        self.assertEqual(overhead.profile_of(summary), [{"part": "pairs", "fraction": 3.0 / 4.001}, {"part": "move", "fraction": 1.0 / 4.001}])

    def test_tables_are_of_one_width(self):
        lines = overhead.table(["a", "b"], [["1", "2"], ["3", "4"]]).splitlines()
        self.assertEqual(lines, ["| a | b |", "| --- | --- |", "| 1 | 2 |", "| 3 | 4 |"])

    def test_scene_and_program_that_end_differently_are_told(self):
        def ended(scene, program):
            return {"parts": [{"part": "grains only", "kinetic_scene_J": scene, "kinetic_program_J": program}]}
        self.assertEqual(overhead.disagreements(ended(1.0, 1.0 + 1e-12)), [])
        self.assertIn("grains only", overhead.disagreements(ended(1.0, 1.0 + 1e-8))[0])


class Atlas(unittest.TestCase):
    def test_studies_have_names_and_folders_of_their_own(self):
        for quick in (True, False):
            studies = atlas.studies(quick)
            self.assertEqual(len({one[0] for one in studies}), len(studies))
            self.assertEqual(len({one[1] for one in studies}), len(studies))

    def test_maps_are_studies_of_scenes_that_are_there(self):
        maps = [command for identity, _, command, _ in atlas.studies(True) if identity.startswith("map: ")]
        self.assertGreater(len(maps), 5)
        for command in maps:
            self.assertTrue((scripts.parent / command[2]).exists(), command)
            self.assertEqual(command.count("--over"), 2)

    def test_what_is_done_stays_and_what_failed_is_done_again(self):
        with tempfile.TemporaryDirectory() as folder:
            for keep, expected in ((False, [["good", 0], ["bad", 3]]), (True, [["good", 0], ["bad", 0]])):
                conduct = atlas.Conduct(Path(folder), keep)
                conduct.run("good", ["sh", "-c", "exit " + ("7" if keep else "0")], "good.json")
                conduct.run("bad", ["sh", "-c", "exit " + ("0" if keep else "3")], "bad.json")
                runs = json.loads((Path(folder) / "runs.json").read_text())
                self.assertEqual([[one["id"], one["status"]] for one in runs], expected)


if __name__ == "__main__":
    unittest.main()
