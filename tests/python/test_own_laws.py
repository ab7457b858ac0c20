"""Contact laws of one's own: numpy for all contacts of a sweep, and compiled ones, beside those of the library."""
import gc
import json
import os
import pathlib
import tempfile
import unittest

import dovetail as dv
import numpy as np

SCENES = pathlib.Path(os.environ["DOVETAIL_SCENES"])
LIBRARY = os.environ["DOVETAIL_OWN_LAWS"]


# Steps until grains have met: surfaces of solids, bonds, an overlap, material points, cells, insertion, clumps, walls
# that move, primitive ones and meshes, periodic space.
SCENES_BESIDE = {"plate": 1400, "bonded-beam": 50, "footing": 10, "snowball": 50, "ball-on-cells": 50, "silo": 1200,
                 "tray": 1300, "drum": 20, "stirrer": 50, "belt": 10, "gate": 20, "wave": 10}


def size(a):
    return np.sqrt(a[:, 0] ** 2 + a[:, 1] ** 2 + a[:, 2] ** 2)


@dv.contact_law(stiffness=("k", "k_t"), damping=lambda c, k, zeta: 2 * zeta * np.sqrt(k * c.effective_mass),
                memory=3, tangential=[0])
def linear(c, k=1e4, k_t=2 / 7 * 1e4, friction=0.4, zeta=0.0):
    """The library's linear law that may pull, in the same order of operations."""
    elastic = k * c.overlap
    damping, seen = 2 * zeta * np.sqrt(k * c.effective_mass), c.seen(k)
    push = elastic - c.engagement_until_end * damping * seen
    limit = np.where(push > 0, friction * push, 0)
    old = k_t * c.memory
    stretched = c.memory + c.slipped
    spring = k_t * size(stretched)
    slides = spring > limit
    stretch = np.where(slides, limit / np.where(slides, spring, 1), 1)[:, None] * stretched
    c.memory = stretch
    held = k_t * stretch
    return {"force": push[:, None] * c.normal - held, "elastic_energy": 0.5 * elastic * c.overlap,
            "tangential_energy": 0.5 * (held * stretch).sum(axis=1),
            "dissipated_power": (elastic - push) * seen,
            "friction_power": 0.5 * ((held + old) * (stretched - stretch)).sum(axis=1) / c.dt}


def beads(n=4, restitution=1.0, radii=(0.01, 0.01), **more):
    """A heap of beads that fall on a floor and spread; SI."""
    r = np.random.default_rng(7).uniform(*radii, n ** 3)
    places = [[0.021 * i, 0.021 * j, 0.012 + 0.021 * k] for i in range(n) for j in range(n) for k in range(n)]
    return {"gravity": [0, 0, -9.81],
            "contact": {"law": "linear", "stiffness": 1e4, "restitution": restitution, "friction": 0.4, "tension": True},
            "particles": [{"from": "list", "density": 2500,
                           "spheres": [{"at": at, "radius": float(one), "velocity": [0.3 * at[2], 0.1, -0.5]}
                                       for at, one in zip(places, r)]}],
            "walls": [{"shape": "plane", "point": [0, 0, 0], "normal": [0, 0, 1], "name": "floor"}],
            "steps": {"dt": 2e-5}, "stages": [{"do": "run", "time": 0.1}], **more}


def zeta(restitution):
    return -np.log(restitution) / np.hypot(np.pi, np.log(restitution))


class BesideTheLibrary(unittest.TestCase):
    def same(self, scene, law, steps, exact=True):
        mine, its = dv.Run(scene, contact_law=law), dv.Run(scene)
        for run in (mine, its):
            run.advance(steps)
        self.assertGreater(its.ledger["particles: contacts"] + its.ledger.get("particles: friction", 0), 1e-6)
        for what in ("x", "v", "omega", "f", "torque"):
            a, b = getattr(mine.grains, what), getattr(its.grains, what)
            if exact:
                np.testing.assert_array_equal(a, b, what)
            else:
                # Pairs of the library remember n·v where those of a function remember the velocity.
                np.testing.assert_allclose(a, b, rtol=0, atol=1e-6 * np.abs(b).max(), err_msg=what)
        return mine, its

    def test_the_same_digits(self):
        for name, more in {"alike": {}, "of several radii": {"radii": (0.007, 0.01)},
                           "periodic": {"periodic": {"box": [[-0.02, -0.02, -1], [0.08, 0.08, 1]], "axes": ["x", "y"]}},
                           }.items():
            with self.subTest(name):
                mine, its = self.same(beads(**more), linear, 5000)  # lists are made anew, and grains sorted
                self.assertEqual(set(mine.ledger), set(its.ledger))
                lost = its.ledger["particles: friction"]
                self.assertAlmostEqual(mine.ledger["particles: friction"] / lost, 1, places=9)
                self.assertAlmostEqual(mine.ledger["residual"], its.ledger["residual"], delta=1e-9 * lost)

    def test_the_same_digits_with_any_number_of_threads(self):
        ends = []
        for threads in (1, 2):
            dv.set_threads(threads)
            run = dv.Run(beads(6), contact_law=linear)
            run.advance(1500)
            ends.append(run.save())
        dv.set_threads(os.cpu_count())
        self.assertEqual(*ends)

    def test_dashpots_nearly(self):
        mine, its = self.same(beads(restitution=0.8), linear(zeta=zeta(0.8)), 600, exact=False)
        lost = its.ledger["particles: dashpots"]
        self.assertAlmostEqual(mine.ledger["particles: dashpots"] / lost, 1, delta=0.02)

    def test_limits_of_the_step(self):
        law = linear(zeta=zeta(0.8))
        mine, its = self.same(beads(restitution=0.8), law, 600, exact=False)
        mine_, its_ = dict(map(reversed, mine.limits)), dict(map(reversed, its.limits))
        self.assertEqual(set(mine_), set(its_))
        for owner, limit in its_.items():
            self.assertAlmostEqual(mine_[owner] / limit, 1, delta=1e-9, msg=owner)
        scene = beads()
        scene["steps"] = {}
        self.assertAlmostEqual(dv.Run(scene, contact_law=linear).dt, dv.Run(scene).dt)

    def test_walls_of_all_kinds(self):
        corners = [[-0.1, -0.1, 0], [0.2, -0.1, 0], [0.2, 0.2, 0], [-0.1, 0.2, 0]]
        facets = "".join("facet normal 0 0 1\nouter loop\n" + "".join(f"vertex {x} {y} {z}\n" for x, y, z in
                                                                      (corners[i] for i in one)) +
                         "endloop\nendfacet\n" for one in ((0, 1, 2), (0, 2, 3)))
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "floor.stl").write_text(f"solid floor\n{facets}endsolid floor\n")
            for wall in ({"shape": "mesh", "file": f"{folder}/floor.stl"},
                         {"shape": "cylinder", "point": [0.03, 0.03, 0.07], "axis": [1, 0, 0], "radius": 0.08},
                         {"shape": "sphere", "centre": [0.03, 0.03, 0.05], "radius": 0.08},
                         {"shape": "box", "box": [[-0.02, -0.02, 0], [0.09, 0.09, 0.2]]}):
                with self.subTest(wall["shape"]):
                    self.same(beads(walls=[wall]), linear, 2500)


class Books(unittest.TestCase):
    def test_residual(self):
        residual = []
        for dt, steps in ((4e-5, 1000), (1e-5, 4000)):
            run = dv.Run(beads(restitution=0.8, steps={"dt": dt}), contact_law=linear(zeta=zeta(0.8)))
            brought = run.kinetic_energy
            run.advance(steps)
            residual.append(abs(run.ledger["residual"]) / brought)
        self.assertLess(residual[0], 5e-3)
        self.assertLess(residual[1], 0.5 * residual[0])
        self.assertEqual(run.notes, dv.Run(beads()).notes)

    def test_momentum(self):
        run = dv.Run(beads(), contact_law=linear)
        run.advance(2000)
        totals = run.totals
        self.assertLess(np.abs(totals["residual"]["linear"]).max(), 1e-12 * totals["turned_over"])
        self.assertLess(np.abs(totals["residual"]["angular"]).max(), 1e-12 * totals["turned_over"])

    def test_says_that_energies_are_lacking(self):
        @dv.contact_law(stiffness="k", torques=False)
        def spring(c, k=1e4):
            return k * c.overlap

        run = dv.Run(beads(), contact_law=spring)
        run.advance(400)
        self.assertIn("contact law spring gives no energies", run.notes[-1])
        self.assertIn("contact law spring gives no energies", str(run))
        self.assertEqual(run.ledger["particles: contacts"], 0)
        self.assertGreater(abs(run.ledger["residual"]), 1e-3 * run.kinetic_energy)

    def test_what_leaves_takes_its_energy_along(self):
        scene = beads(domain={"box": [[-0.01, -1, -1], [0.0635, 1, 1]], "escape": "remove"})
        run = dv.Run(scene, contact_law=linear)
        brought = run.kinetic_energy
        run.advance(5000)
        self.assertLess(len(run.grains), 64)
        self.assertLess(abs(run.ledger["residual"]), 3e-3 * brought)
        its = dv.Run(scene)
        its.advance(5000)
        np.testing.assert_array_equal(run.grains.x, its.grains.x)


class Memory(unittest.TestCase):
    def test_goes_on_from_states(self):
        run = dv.Run(beads(), contact_law=linear)
        run.advance(1500)
        state = run.save()
        run.advance(1000)
        other = dv.Run(beads(), contact_law=linear)
        other.load(state)
        other.advance(1000)
        self.assertEqual(other.save(), run.save())

    def test_states_name_their_law(self):
        state = dv.Run(beads(), contact_law=linear).save()
        with self.assertRaisesRegex(ValueError, "under the laws 'own law linear'"):
            dv.Run(beads()).load(state)
        with self.assertRaisesRegex(ValueError, "parameters of the laws 'own law linear'"):
            dv.Run(beads(), contact_law=linear(friction=0.5)).load(state)
        with self.assertRaisesRegex(ValueError, "under the laws 'linear"):
            dv.Run(beads(), contact_law=linear).load(dv.Run(beads()).save())

    def test_counts_the_steps_of_each_contact(self):
        ages = []

        @dv.contact_law(stiffness="k", memory=1, torques=False)
        def ageing(c, k=1e4):
            c.memory[:, 0] += np.where(c.overlap_before > 0, 1, 0)
            new = c.overlap_before < 0
            self.assertTrue((c.memory[new] == 0).all())
            ages.append(c.memory[:, 0].max(initial=0))
            return k * c.overlap

        run = dv.Run(beads(), contact_law=ageing)
        run.advance(3000)
        self.assertGreater(max(ages), 30)
        self.assertLess(max(ages), 3000)

    def test_scenes_as_a_whole(self):
        scene = beads(output={"checkpoints": "0.02 s", "series": "0.01 s"})
        scene["stages"] = [{"do": "run", "time": 0.04}]
        with tempfile.TemporaryDirectory() as folder:
            half, whole = f"{folder}/half", f"{folder}/whole"
            dv.run(scene, out=whole, quiet=True, contact_law=linear)
            cut = json.loads(json.dumps(scene))
            cut["stages"][0]["time"] = 0.02
            dv.run(cut, out=half, quiet=True, contact_law=linear)
            with self.assertRaisesRegex(ValueError, "contact"):
                dv.resume(half, until=0.04, quiet=True)
            dv.resume(half, until=0.04, quiet=True, contact_law=linear)
            self.assertEqual(pathlib.Path(half, "series.csv").read_bytes(),
                             pathlib.Path(whole, "series.csv").read_bytes())
        self.assertIn("own law linear", dv.check(scene, contact_law=linear))


class Given(unittest.TestCase):
    def test_contacts(self):
        kept = []

        @dv.contact_law(stiffness="k", memory=2)
        def law(c, k=1e4):
            n = len(c)
            shapes = {"overlap": (n,), "overlap_before": (n,), "separating": (n,), "effective_mass": (n,),
                      "effective_radius": (n,), "normal": (n, 3), "slip": (n, 3), "spin": (n, 3), "slipped": (n, 3), "turned": (n, 3),
                      "engagement": (n,), "engagement_until_end": (n,), "memory": (n, 2),
                      "first": (n,), "second": (n,)}
            for name, shape in shapes.items():
                self.assertEqual(getattr(c, name).shape, shape, name)
            self.assertTrue((c.overlap > 0).all())
            np.testing.assert_allclose(size(c.normal), 1)
            np.testing.assert_allclose((c.slip * c.normal).sum(axis=1), 0, atol=1e-12)
            of_walls = c.second < 0
            self.assertIn(of_walls.sum(), (0, n))
            np.testing.assert_allclose(c.effective_radius, 0.01 if of_walls.any() else 0.005)
            kept.append((c, c.overlap, c.overlap.copy()))
            return {"force": k * c.overlap, "couple": np.zeros((n, 3))}

        run = dv.Run(beads(), contact_law=law)
        run.advance(700)
        contacts = run.grains.contacts()
        self.assertGreater(len(kept), 3)
        for c, view, copy in kept:
            np.testing.assert_array_equal(view, copy)  # arrays that are kept stay as they were
        with self.assertRaisesRegex(ValueError, "step of these contacts is over"):
            kept[0][0].first
        self.assertEqual(len(contacts["first"]), len(contacts["force"]))
        del kept[:], c, view
        gc.collect()

    def test_reach(self):
        @dv.contact_law(stiffness="k", reach=0.002, torques=False)
        def sticky(c, k=1e4, pull=0.5):
            return np.where(c.overlap > 0, k * c.overlap, 0) - pull

        at = [{"at": [0, 0, 0], "radius": 0.01}, {"at": [0.0215, 0, 0], "radius": 0.01}]
        scene = {"particles": [{"from": "list", "density": 2500, "spheres": at}], "steps": {"dt": 1e-5},
                 "stages": [{"do": "run", "time": 1}]}
        run = dv.Run(scene, contact_law=sticky)
        run.advance(1)
        np.testing.assert_allclose(run.grains.f[:, 0], [0.5, -0.5])

    def test_couples(self):
        @dv.contact_law(stiffness="k")
        def turning(c, k=1e4):
            return {"force": 0 * c.overlap, "couple": np.outer(np.ones(len(c)), [0, 0, 1e-3])}

        at = [{"at": [0, 0, 0], "radius": 0.01}, {"at": [0.0199, 0, 0], "radius": 0.01}]
        scene = {"particles": [{"from": "list", "density": 2500, "spheres": at}], "steps": {"dt": 1e-5},
                 "stages": [{"do": "run", "time": 1}]}
        run = dv.Run(scene, contact_law=turning)
        run.advance(1)
        np.testing.assert_allclose(run.grains.torque, [[0, 0, 1e-3], [0, 0, -1e-3]])


class Beside(unittest.TestCase):
    """Whatever has contacts takes them."""

    def test_shipped_scenes(self):
        law = {"law": "linear", "stiffness": 1e4, "friction": 0.4, "tension": True}
        for name, steps in SCENES_BESIDE.items():
            with self.subTest(name):
                calls = []

                @dv.contact_law(stiffness=("k", "k_t"), memory=3, tangential=[0])
                def counted(c, k=1e4, k_t=2 / 7 * 1e4):
                    calls.append(len(c))
                    return linear._function(c, k, k_t)
                mine = dv.Run(SCENES / f"{name}.json", contact=law, contact_law=counted)
                its = dv.Run(SCENES / f"{name}.json", contact=law)
                for run in (mine, its):
                    run.advance(steps)
                self.assertGreater(sum(calls), 0)
                self.assertEqual(mine.dt, its.dt)
                np.testing.assert_array_equal(mine.grains.x, its.grains.x)
                np.testing.assert_array_equal(mine.grains.v, its.grains.v)
                for solid in its.solids:
                    np.testing.assert_array_equal(mine.solids[solid].u, its.solids[solid].u)


class Refusals(unittest.TestCase):
    def refused(self, answer, text, error=ValueError, memory=0):
        @dv.contact_law(stiffness="k", memory=memory)
        def law(c, k=1e4):
            return answer(c)

        run = dv.Run(beads(), contact_law=law)
        with self.assertRaisesRegex(error, text):
            run.advance(2000)
        with self.assertRaisesRegex(ValueError, "broken off"):
            run.advance(1)

    def test_answers(self):
        nan = np.nan
        self.refused(lambda c: np.zeros(len(c) + 1), r"shape of its force is \(\d+\).*give \(\d+\), along the normals")
        self.refused(lambda c: np.zeros((len(c), 2)), r"shape of its force is \(\d+, 2\)")
        self.refused(lambda c: None, "force")
        self.refused(lambda c: "push", "force is no array of numbers")
        self.refused(lambda c: {"push": c.overlap}, 'no answer "push"')
        self.refused(lambda c: {"couple": c.normal}, "answers no force")
        self.refused(lambda c: nan * c.overlap, r"force at the contact of grains? \d+ (and \d+|with a wall or solid) is not")
        self.refused(lambda c: {"force": c.overlap, "elastic_energy": nan * c.overlap}, "elastic_energy at the contact of")
        self.refused(lambda c: {"force": c.overlap, "friction_power": np.inf + c.overlap}, "friction_power at the contact")
        self.refused(lambda c: {"force": c.overlap, "elastic_energy": c.normal}, r"shape of its elastic_energy is")

        def forgets(c):
            c.memory[:, 0] = nan
            return c.overlap
        self.refused(forgets, "memory 0 at the contact of grain", memory=1)

        def misremembers(c):
            c.memory = np.zeros((len(c), 2))
        self.refused(misremembers, r"give \(\d+, 1\)", memory=1)

    def test_exceptions_come_through(self):
        class Mine(Exception):
            pass

        def fails(c):
            raise Mine("stop here")
        self.refused(fails, "stop here", Mine)

    def test_looks_at_the_run(self):
        seen = {}

        @dv.contact_law(stiffness="k")
        def looks(c, k=1e4):
            if "run" in seen:
                seen["run"].grains.x
            return k * c.overlap
        seen["run"] = dv.Run(beads(), contact_law=looks)
        with self.assertRaisesRegex(ValueError, "a step is under way"):
            seen["run"].advance(2000)

    def test_definitions(self):
        def law(c, k=1e4):
            return k * c.overlap
        made = dv.contact_law
        for wrong, text in ((lambda: made(stiffness=1e4)(lambda c, k: 0), "has no value"),
                            (lambda: made(stiffness=1e4)(lambda c, k="stiff": 0), "finite number"),
                            (lambda: made(stiffness=1e4)(law)(mu=0.3), "no parameter mu: it has k"),
                            (lambda: made(stiffness=1e4)(law)(k=np.nan), "finite number"),
                            (lambda: dv.Run(beads(), contact_law=law), "no contact law"),
                            (lambda: dv.Run(beads(), contact_law=made(1e4, memory=11)(law)), "0 to 10"),
                            (lambda: dv.Run(beads(), contact_law=made(1e4, memory=2, tangential=[0])(law)), "tangential"),
                            (lambda: dv.Run(beads(), contact_law=made(1e4, reach=-1)(law)), "reach"),
                            (lambda: dv.Run(beads(), contact_law=made("stiff")(law)), "no parameter stiff"),
                            (lambda: dv.Run(beads(), contact_law=made(0.0)(law)), "stiffness of a contact is not"),
                            (lambda: dv.Run(beads(), contact_law=made(lambda c: np.zeros((2, 2)))(law)), "shape")):
            with self.assertRaisesRegex(ValueError, text):
                wrong()

    def test_scenes(self):
        pairs = beads()
        pairs["contacts"] = [{"between": "a", "and": "a", **pairs.pop("contact")}]
        pairs["particles"][0]["contact_material"] = "a"
        pairs["walls"][0]["contact_material"] = "a"
        with self.assertRaisesRegex(ValueError, "laws by pairs of contact materials"):
            dv.Run(pairs, contact_law=linear)
        bonded = beads()
        bonded["contact"] = {"law": "linear", "stiffness": 1e4, "bonded": True}
        with self.assertRaisesRegex(ValueError, "bonded"):
            dv.Run(bonded, contact_law=linear)
        changing = beads()
        changing["stages"].append({"do": "run", "time": 0.1, "changes": {"contact": beads()["contact"]}})
        with self.assertRaisesRegex(ValueError, "a stage changes the law"):
            dv.check(changing, contact_law=linear)
        with self.assertRaisesRegex(ValueError, "beyond|limit"):
            run = dv.Run(beads(steps={"dt": 5e-3}), contact_law=linear)
            run.advance(1)


class Compiled(unittest.TestCase):
    def test_the_same_digits(self):
        laws = dv.load_laws(LIBRARY)
        self.assertEqual(set(laws), {"linear", "stiffening"})
        scene = beads(restitution=0.8)
        del scene["contact"]["tension"]
        runs = [dv.Run(scene, contact_law=laws["linear"](k=1e4, restitution=0.8, friction=0.4)), dv.Run(scene)]
        for run in runs:
            run.advance(5000)
        for what in ("x", "v", "omega", "f", "torque"):
            np.testing.assert_array_equal(*(getattr(run.grains, what) for run in runs), what)
        self.assertEqual(runs[0].ledger, runs[1].ledger)
        self.assertEqual(runs[0].limits, runs[1].limits)

    def test_beside_numpy(self):
        @dv.contact_law(stiffness=lambda c, k, height: k * (1 + 3 * (c.overlap / height) ** 2))
        def stiffening(c, k=1e5, height=1e-4):
            squared = c.overlap ** 2 / height ** 2
            return {"force": k * c.overlap * (1 + squared),
                    "elastic_energy": 0.5 * k * c.overlap ** 2 * (1 + 0.5 * squared)}

        law = dv.load_laws(LIBRARY)["stiffening"](k=1e4, height=2e-4, damping_ratio=0.0)
        self.assertEqual(repr(law), "stiffening(damping_ratio=0, friction=0, height=0.0002, k=10000)")
        runs = [dv.Run(beads(), contact_law=law), dv.Run(beads(), contact_law=stiffening(k=1e4, height=2e-4))]
        for run in runs:
            run.advance(600)
        np.testing.assert_allclose(runs[0].grains.x, runs[1].grains.x, rtol=0, atol=1e-12)
        energy = [run.ledger["particles: contacts"] for run in runs]
        self.assertAlmostEqual(energy[0] / energy[1], 1, delta=1e-9)
        self.assertEqual(len(runs[0].limits), len(runs[1].limits))

    def test_states_name_their_law(self):
        laws = dv.load_laws(LIBRARY)
        run = dv.Run(beads(), contact_law=laws["stiffening"])
        with self.assertRaisesRegex(ValueError, "under the laws 'own law stiffening'"):
            dv.Run(beads()).load(run.save())
        with self.assertRaisesRegex(ValueError, "parameters of the laws 'own law stiffening'"):
            dv.Run(beads(), contact_law=laws["stiffening"](k=2e5)).load(run.save())
        dv.Run(beads(), contact_law=laws["stiffening"]).load(run.save())

    def test_refuses(self):
        with tempfile.TemporaryDirectory() as folder:
            no_library = pathlib.Path(folder, "text.so")
            no_library.write_text("no library")
            with self.assertRaisesRegex(ValueError, "cannot be opened"):
                dv.load_laws(no_library)
        with self.assertRaisesRegex(ValueError, "cannot be opened"):
            dv.load_laws("nowhere.so")
        with self.assertRaisesRegex(ValueError, "has no contact laws"):
            dv.load_laws(dv._core.__file__)
        with self.assertRaisesRegex(ValueError, "no parameter mu"):
            dv.load_laws(LIBRARY)["linear"](mu=0.3)
        with self.assertRaisesRegex(ValueError, "must be > 0"):
            dv.Run(beads(), contact_law=dv.load_laws(LIBRARY)["stiffening"](height=0))


if __name__ == "__main__":
    unittest.main()
