"""Views of the grains: no copy while they are open, nothing that dangles afterwards."""
import unittest

import dovetail as dv
import numpy as np

from test_run import beads


class Views(unittest.TestCase):
    def test_are_the_memory_of_the_run(self):
        run = dv.Run(beads())
        run.advance(100)
        x, v, order = run.grains.x, run.grains.v, np.argsort
        with run.grains.views() as g:
            rows = order(g.id)
            np.testing.assert_array_equal(g.x[rows], x)
            np.testing.assert_array_equal(g.v[rows], v)
            g.v[:] = 0
            g.v[3] += [1, 2, 3]
            g.v[g.id == 5, 0] = -1
            names = g.id.copy()
            self.assertEqual(g.x.shape, (64, 3))
            self.assertEqual(g.radius.sum(), 64 * 0.01)
            np.testing.assert_allclose(np.linalg.norm(g.omega, axis=1), 0)
        expected = np.zeros((64, 3))
        expected[names[3]] = [1, 2, 3]
        expected[5, 0] = -1
        np.testing.assert_array_equal(run.grains.v, expected)

    def test_what_they_change_is_booked(self):
        one, other = dv.Run(beads()), dv.Run(beads())
        energy = one.kinetic_energy
        for run in (one, other):
            run.advance(200)
        with one.grains.views() as g:
            g.v[:] *= 0.5
            g.omega[:] = [0, 0, 1]
        v = other.grains.v
        other.grains.v = 0.5 * v
        other.grains.omega = [0, 0, 1]
        one.advance(1000)
        other.advance(1000)
        np.testing.assert_array_equal(one.grains.x, other.grains.x)
        self.assertLess(abs(one.ledger["residual"]), 1e-3 * energy)
        self.assertEqual(one.ledger["residual"], other.ledger["residual"])
        self.assertAlmostEqual(one.ledger["changes (minus)"], other.ledger["changes (minus)"], 12)
        self.assertGreater(one.ledger["changes (minus)"], 0)

    def test_reading_changes_nothing(self):
        one, other = dv.Run(beads()), dv.Run(beads())
        for _ in range(20):
            with one.grains.views() as g:
                self.assertTrue(np.isfinite(g.v).all())
                height = g.x[:, 2].max()
            one.advance(20)
        other.advance(400)
        self.assertGreater(height, 0.05)
        self.assertEqual(one.save(), other.save())

    def test_lock_the_run(self):
        run = dv.Run(beads(2))
        with run.grains.views():
            for act in (lambda: run.advance(1), lambda: run.grains.x, lambda: run.ledger, lambda: run.save(),
                        lambda: run.force(lambda t, x, v: 0 * x), lambda: run.grains.views().__enter__(),
                        lambda: run.move_wall("floor", velocity=lambda t: [0, 0, 0])):
                with self.assertRaisesRegex(dv.InputError, "views of its grains are open"):
                    act()
        run.advance(1)

    def test_cannot_be_opened_within_a_step(self):
        run = dv.Run(beads(2))
        started = []

        def force(t, x, v):
            if started:
                run.grains.views().__enter__()
            return 0 * x

        run.force(force)
        started.append(True)
        with self.assertRaisesRegex(dv.InputError, "a step is under way"):
            run.advance(1)


class Escaped(unittest.TestCase):
    def test_raise_whatever_they_are_asked_for(self):
        run = dv.Run(beads(2))
        with run.grains.views() as g:
            v, row, part = g.v, g.v[0], g.x[1:3, 2]
        asks = (lambda a: a[0], lambda a: a + 1, lambda a: a.sum(), lambda a: a.copy(), lambda a: np.mean(a),
                lambda a: np.sort(a), lambda a: list(a), lambda a: str(a), lambda a: a.tolist(), lambda a: a == 0,
                lambda a: np.add(1, 1, out=a), lambda a: a.__setitem__(0, 1), lambda a: a.__iadd__(1))
        for ask in asks:
            for array in (v, row, part):
                with self.assertRaisesRegex(dv.InputError, "has ended"):
                    ask(array)
        with self.assertRaisesRegex(dv.InputError, "closed"):
            g.v

    def test_do_not_reach_the_run_or_what_it_has_freed(self):
        run = dv.Run(beads())
        kept = []
        for _ in range(5):
            with run.grains.views() as g:
                fields = [np.asarray(getattr(g, name)) for name in ("x", "v", "omega", "f", "radius", "mass", "id")]
                kept.append([(array, array.copy()) for array in fields])
                memory = memoryview(g.v)
            run.advance(200)
        state = run.save()
        for fields in kept:
            for array, copy in fields:
                np.testing.assert_array_equal(array, copy)  # as it was, whatever the run has done since
            fields[1][0][:] = np.nan
        self.assertEqual(run.save(), state)
        del run, g
        self.assertEqual(len(memory.tobytes()), 64 * 3 * 8)
        np.testing.assert_array_equal(kept[2][0][0], kept[2][0][1])

    def test_copies_stay(self):
        run = dv.Run(beads(2))
        with run.grains.views() as g:
            v, fast, twice = g.v.copy(), g.v[g.v[:, 2] < 0], 2 * g.v
        run.advance(10)
        self.assertEqual(v.sum(), fast.sum())
        self.assertEqual(twice.sum(), 2 * v.sum())


class Refused(unittest.TestCase):
    def test_what_only_the_run_may_write(self):
        run = dv.Run(beads(2))
        with run.grains.views() as g:
            for array in (g.x, g.f, g.mass, g.id):
                with self.assertRaisesRegex(ValueError, "read-only"):
                    array[0] = 0

    def test_numbers_that_are_not_finite(self):
        run = dv.Run(beads(2))
        state = run.save()
        with self.assertRaisesRegex(dv.InputError, "row 2 of v is not finite"):
            with run.grains.views() as g:
                g.v[2] = np.inf
        self.assertEqual(run.save(), state)

    def test_an_error_within_leaves_the_run_as_it_was(self):
        run = dv.Run(beads(2))
        state = run.save()
        with self.assertRaises(KeyError):
            with run.grains.views() as g:
                g.v[:] = 0
                raise KeyError
        self.assertEqual(run.save(), state)
        run.advance(1)

    def test_runs_with_clumps_and_without_spins(self):
        scene = beads(2)
        scene["clumps"] = [{"density": 2500, "at": [1, 1, 1],
                            "spheres": [{"at": [0, 0, 0], "radius": 0.01}, {"at": [0.01, 0, 0], "radius": 0.01}]}]
        with self.assertRaisesRegex(dv.InputError, "part of a clump"):
            dv.Run(scene).grains.views().__enter__()
        with dv.Run(beads(2, spin=False)).grains.views() as g:
            with self.assertRaisesRegex(dv.InputError, "do not spin"):
                g.omega

    def test_what_is_not_open(self):
        views = dv.Run(beads(2)).grains.views()
        with self.assertRaisesRegex(dv.InputError, "not open"):
            views.v
        with views:
            pass
        with self.assertRaisesRegex(dv.InputError, "have been"):
            views.__enter__()


if __name__ == "__main__":
    unittest.main()
