# SPDX-License-Identifier: MIT
"""The Python module as a user has it: run by ctest with the build's module in PYTHONPATH, CATENA the program, SOURCE the checkout."""
import csv
import html
import inspect
import json
import os
import pathlib
import re
import struct
import subprocess
import tempfile
import threading
import time
import unittest
import unittest.mock
import urllib.error
import urllib.request
import warnings

import numpy as np

import catena

SOURCE, PROGRAM = os.environ["SOURCE"], os.environ["CATENA"]
os.environ["PATH"] = os.path.dirname(PROGRAM) + ":" + os.environ["PATH"]


def run(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, check=False)


def ball(n=33):
    """Distances from the middle, times the index's own scale: z, y, x."""
    z, y, x = np.ogrid[:n, :n, :n]
    middle = n // 2
    return np.sqrt((x - middle) ** 2 + (y - middle) ** 2 + (z - middle) ** 2)


class Fields(unittest.TestCase):
    def test_arrays_of_all_kinds_hold_the_same_values(self):
        a = np.arange(4 * 5 * 6).reshape(4, 5, 6)
        places = np.array([[x, y, z] for z in range(4) for y in range(5) for x in range(6)], float)
        for kind in "float32 float64 uint8 int8 uint16 int16 uint32 int32 uint64 int64".split():
            np.testing.assert_array_equal(catena.field(a.astype(kind)).sample(places), a.ravel(), kind)
        np.testing.assert_array_equal(catena.field(a.astype("float16")).sample(places), a.ravel())
        for kind in ">f4", ">f8", ">i2", ">u4", ">f2":
            np.testing.assert_array_equal(catena.field(a.astype(kind)).sample(places), a.ravel(), kind)
        # what is masked is no voxel
        masked = catena.field(np.ma.masked_greater(a, 60))
        self.assertEqual(masked.range, (0, 60))
        # strides of every kind are read where they lie
        np.testing.assert_array_equal(catena.field(a.T, axes="xyz").sample(places), a.ravel())
        np.testing.assert_array_equal(catena.field(np.asfortranarray(a)).sample(places), a.ravel())
        np.testing.assert_array_equal(catena.field(a[::-1, :, ::2]).sample([[1, 2, 0]]), [a[3, 2, 2]])
        np.testing.assert_array_equal(a, np.arange(120).reshape(4, 5, 6))

    def test_vectors_are_what_is_said(self):
        rng = np.random.default_rng(2)
        flat, line, full = rng.random((8, 9, 2)), rng.random((7, 3)), rng.random((4, 5, 6, 2))
        at = [[3, 4, 0], [3, 4, 1]]
        with self.assertWarnsRegex(UserWarning, r"shape \(8, 9, 2\) is read as scalars; vectors=True reads 2 components"):
            thin = catena.field(flat)
        self.assertFalse(thin.is_vector)
        np.testing.assert_allclose(thin.sample([[1, 3, 4]]), [flat[4, 3, 1]], rtol=1e-6)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            for f, value in ((catena.field(flat, vectors=True), [*flat[4, 3], 0]), (catena.field(flat[None]), [*flat[4, 3], 0]),
                             (catena.field(flat.swapaxes(0, 1), axes="xyz", vectors=True), [*flat[4, 3], 0])):
                self.assertTrue(f.is_vector)
                np.testing.assert_allclose(f.sample(at), [value, value], rtol=1e-6)
            np.testing.assert_allclose(catena.field(line, vectors=True).sample([[5, 0, 0]]), [line[5]], rtol=1e-6)
            np.testing.assert_allclose(catena.field(full).sample([[5, 4, 3]]), [[*full[3, 4, 5], 0]], rtol=1e-6)
            self.assertFalse(catena.field(flat, vectors=False).is_vector)
            np.testing.assert_allclose(catena.field(flat[:, :, 0]).sample(at), [flat[4, 3, 0]] * 2, rtol=1e-6)
        for wrong, chosen in ((full, False), (rng.random((4, 5, 6, 4)), None), (flat[:, :, :1], True), (np.float32(1), None)):
            with self.assertRaisesRegex(catena.Error, "the array has the shape"):
                catena.field(wrong, vectors=chosen)

    def test_an_error_of_a_dict_names_its_place(self):
        scene = {"fields": {"a": {"analytic": "hill"}}, "volumes": [{"field": "a", "opacity": "much"}]}
        with self.assertRaisesRegex(catena.Error, "^scene: /volumes/0/opacity: "):
            catena.render(scene, 32, 24)
        scene["volumes"] = [{"field": "a"}, {"field": "b"}]
        with self.assertRaisesRegex(catena.Error, "^scene: /volumes/1/field: "):
            catena.render(scene, 32, 24)
        # of what is found out when it is used, too
        with self.assertRaisesRegex(catena.Error, "^scene: /fields/a~1b: "):
            catena.render({"fields": {"a/b": {"file": "none.vdb"}}, "volumes": [{"field": "a/b"}]}, 32, 24)

    def test_memory_has_a_limit(self):
        a = np.zeros((80, 80, 80), np.float32)  # 2 MB
        catena.memory_limit(1)
        try:
            with self.assertRaisesRegex(catena.Error, r"expected at most \d MB \(catena\.memory_limit\(MB\) allows more\)"):
                catena.field(a)
        finally:
            catena.memory_limit(None)
        catena.field(a)
        for wrong in (0, -1, float("nan"), 1e300):
            with self.assertRaises(catena.Error):
                catena.memory_limit(wrong)

    def test_the_affine_maps_voxels_to_the_world(self):
        affine = np.array([[0, -2, 0, 10], [3, 0, 0, -4], [0, 0, 0.5, 1], [0, 0, 0, 1]], float)
        a = np.random.default_rng(1).random((5, 6, 7)).astype(np.float32)
        f = catena.field(a, axes="xyz", affine=affine)
        for voxel in ((0, 0, 0), (4, 5, 6), (2, 3, 1)):
            world = affine @ np.array([*voxel, 1.0])
            self.assertAlmostEqual(f.sample(world[:3])[0], a[voxel], places=6)

    def test_gradients_are_derivatives_and_vectors_keep_their_components(self):
        z, y, x = np.mgrid[:4, :5, :6].astype(float)
        f = catena.field(2 * x - 3 * y + 0.5 * z)
        np.testing.assert_allclose(f.gradient([[1.5, 2.25, 1.1]]), [[2, -3, 0.5]])
        v = catena.field(np.stack([x, 10 * y, 100 * z], axis=3))
        self.assertTrue(v.is_vector)
        np.testing.assert_allclose(v.sample([1.5, 2.5, 0.5]), [[1.5, 25, 50]])
        self.assertTrue(np.isnan(f.sample([[99, 0, 0]])).all())

    def test_fields_are_derived_from_fields(self):
        z, y, x = np.meshgrid(np.arange(9.0), np.arange(8.0), np.arange(7.0), indexing="ij")
        flow = catena.field(np.stack([-y, x, 0 * z], axis=-1))
        np.testing.assert_allclose(flow.derived("vorticity").sample([3, 3, 3]), [[0, 0, 2]])
        np.testing.assert_allclose(flow.derived("q_criterion", order=4).sample([3, 3, 3]), [1])
        np.testing.assert_allclose(flow.component(1).derived("gradient").sample([3, 3, 3]), [[1, 0, 0]])
        np.testing.assert_allclose(flow.smoothed(1).sample([3, 4, 3]), [[-4, 3, 0]], atol=0.01)
        abc = catena.analytic("abc")
        np.testing.assert_allclose(abc.derived("vorticity").sample([0.1, 0.2, 0.3]), abc.sample([0.1, 0.2, 0.3]), rtol=1e-11)
        np.testing.assert_allclose(abc.resampled(flow).sample([2, 3, 4]), abc.sample([2, 3, 4]), rtol=1e-6)
        for wrong, part in ((lambda: flow.derived("curl"), "is not known"), (lambda: flow.derived("gradient"), "a scalar field was expected"),
                            (lambda: flow.derived("vorticity", 3), "2 or 4"), (lambda: abc.smoothed(1), "a field on a grid"),
                            (lambda: flow.resampled(abc), "no nodes")):
            with self.assertRaisesRegex(catena.Error, part):
                wrong()

    def test_one_copy_is_all(self):
        # a program apart: the peak of this one is already higher
        code = ("import numpy as np, catena, resource\n"
                "a = np.random.default_rng(1).random((200, 200, 200))\n"  # 64 MB; the field holds 32 MB
                "before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss\n"
                "f = catena.field(a)\n"
                "print((resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) * 1024 / f.bytes)\n")
        done = subprocess.run([os.sys.executable, "-c", code], capture_output=True, text=True, check=True)
        self.assertLess(float(done.stdout), 2)

    def test_files(self):
        with tempfile.TemporaryDirectory() as folder:
            path = f"{folder}/a.vdb"
            self.assertEqual(run("generate", "sphere", "-o", path, "--resolution", "16").returncode, 0)
            f = catena.field(path)
            self.assertTrue(f.is_grid)
            f.save(f"{folder}/b.vdb")
            np.testing.assert_array_equal(catena.field(f"{folder}/b.vdb").sample([[0.3, 0.1, 0]]), f.sample([[0.3, 0.1, 0]]))


class Errors(unittest.TestCase):
    def says(self, words, call, kind=catena.Error):
        with self.assertRaises(kind) as caught:
            call()
        self.assertIn(words, str(caught.exception))
        self.assertNotIn("\n", str(caught.exception))

    def test_they_are_the_program_s_one_line(self):
        with tempfile.TemporaryDirectory() as folder:
            path = f"{folder}/s.json"
            with open(path, "w", encoding="utf-8") as file:
                file.write('{"chain": [\n {"name": "skin", "type": "isosurfac"}]}')
            with self.assertRaises(catena.Error) as caught:
                catena.Chain(path)
            probe = SOURCE + "/assets/probes/first.csv"
            told = run("replay", path, "--probe", probe, "-o", f"{folder}/t.csv").stderr
            self.assertEqual("catena: " + str(caught.exception) + "\n", told)

    def test_what_cannot_be_used_is_named(self):
        self.says("the shape (2, 2, 2, 2, 2)", lambda: catena.field(np.zeros((2,) * 5)))
        self.says("axes is \"3\"", lambda: catena.field(np.zeros((3, 3, 3)), axes=3))
        self.says("last row", lambda: catena.field(np.zeros((3, 3, 3)), affine=np.ones((4, 4)) + np.eye(4)))
        with self.assertRaisesRegex(TypeError, "^'float' object"):
            catena.render({}, 10.5, 10)
        self.says("from 1 to 16384", lambda: catena.render({}, 2 ** 70, 10))
        self.says("no finite value", lambda: catena.field(np.full((3, 3, 3), np.nan)))
        self.says("complex", lambda: catena.field(np.zeros((3, 3, 3), complex)))
        self.says("from 2 to", lambda: catena.field(np.zeros((0, 3, 3))))
        self.says("cannot be inverted", lambda: catena.field(np.zeros((3, 3, 3)), affine=np.diag([0, 0, 0, 1])))
        self.says("(N, 3)", lambda: catena.analytic("sphere").sample([[1, 2]]))
        self.says("unknown field", lambda: catena.render({"isosurfaces": [{"field": "b", "level": 1}]}))
        self.says("seeds[1]", lambda: catena.trace(catena.analytic("saddle"), [[1, 1, 0], [0, 0, 0]]))
        self.says("positions", lambda: catena.Chain({}).run([[1, 2]]))
        self.says("is no folder", lambda: catena.trade_report("/nowhere"))
        field = catena.analytic("circle")
        self.says("real numbers", lambda: field.sample("abc"))
        self.says("real numbers", lambda: field.sample([[1, 2, 3], [1]]))
        self.says("complex128", lambda: field.sample(np.zeros((2, 3), complex)))
        for bad in -1, np.nan, np.inf:
            self.says("length is", lambda bad=bad: catena.trace(field, [1, 0, 0], length=bad))
        self.says("a?b", lambda: catena.field(np.zeros((2,) * 5), name="a\nb"))
        self.says("/a?b.vdb: there is no such file", lambda: catena.field("/a\0b.vdb"))
        self.says("there is no such file", lambda: catena.field("/a\udcffb.vdb"))
        self.says("fields: 1 is no name", lambda: catena.Chain({}, fields={1: np.zeros((3, 3, 3))}))
        self.says("a set has no place", lambda: catena.Chain({"chain": {1, 2}}))
        self.says("not JSON compliant", lambda: catena.Chain({"coupling": {"stiffness": np.nan}}))
        chain = catena.Chain({})
        self.says("several points", lambda: chain.step([[1, 1, 1]] * 2))
        for bad in [-1, 0], [0.5, 0], [2.0 ** 32, 0], [np.nan, 0]:
            self.says("buttons: holds", lambda bad=bad: chain.run([[1, 1, 1]] * 2, buttons=bad))
        for bad, said in ([1, 1], "t: 1 s after 1 s"), ([2, 1], "t: 1 s after 2 s"), ([1, np.nan], "t: holds nan"):
            self.says(said, lambda bad=bad: chain.run([[1, 1, 1]] * 2, t=bad))
        self.assertEqual(chain.ticks, 0)
        self.says("buttons does not have", lambda: chain.run([[1, 1, 1]] * 2, buttons=[1]))
        self.assertTrue(issubclass(catena.MachineError, catena.Error) and issubclass(catena.Error, ValueError))


class Curves(unittest.TestCase):
    def test_a_circle_comes_back(self):
        curve = catena.trace(catena.analytic("circle"), [[0.5, 0, 0]])[0]
        self.assertTrue(curve.closed)
        np.testing.assert_allclose(np.linalg.norm(curve.points[:, :2], axis=1), 0.5, atol=1e-8)
        self.assertAlmostEqual(curve.s[-1] - curve.s[0], np.pi, places=7)
        np.testing.assert_allclose(np.abs(curve.at([np.pi / 2])), [[0.5, 0, 0]], atol=1e-7)


    def test_a_particle_in_a_turning_flow(self):
        steps = [catena.field(np.tile(v, (9, 9, 9, 1)).astype("f4"), vectors=True) for v in ([1, 0, 0], [0, 1, 0])]
        path = catena.trace_unsteady(steps, [0, 2], [2, 2, 2])[0][0]
        np.testing.assert_allclose(path.points[-1], [3, 3, 2], atol=1e-9)
        np.testing.assert_allclose(path.points[:, 1], 2 + path.times ** 2 / 4, atol=1e-9)
        streak = catena.trace_unsteady(steps, [0, 2], [[2, 2, 2]], lines="streak")[0][0]
        np.testing.assert_allclose(streak.points[:, 1], 3 - streak.times ** 2 / 4, atol=1e-9)
        with self.assertRaisesRegex(catena.Error, "times.1. does not rise"):
            catena.trace_unsteady(steps, [0, 0], [2, 2, 2])


class Chains(unittest.TestCase):
    def probe(self, name):
        with open(f"{SOURCE}/assets/probes/{name}.csv", encoding="utf-8") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        return (np.array([float(r["t"]) for r in rows]), np.array([[float(r[k]) for k in "xyz"] for r in rows]),
                np.array([int(r.get("buttons") or 0) for r in rows]))

    def test_the_same_bits_as_replay_and_step_by_step(self):
        t, places, buttons = self.probe("first")
        scene = SOURCE + "/assets/scenes/first.json"
        chain = catena.Chain(scene)
        ticks = chain.run(places, t, buttons)
        with tempfile.TemporaryDirectory() as folder:
            told = run("replay", scene, "--probe", SOURCE + "/assets/probes/first.csv", "-o", f"{folder}/t.csv", "--stats", f"{folder}/s.json")
            self.assertEqual(told.returncode, 0, told.stderr)
            with open(f"{folder}/s.json", encoding="utf-8") as file:
                self.assertEqual(int(json.load(file)["state_hash"], 16), chain.state_hash)
        self.assertEqual(ticks.proxies.shape, (len(t), 2, 3))
        self.assertEqual(chain.links, ["curve", "skin"])
        again = catena.Chain(scene)
        halves = [again.run(part, tt, bb) for part, tt, bb in zip(np.array_split(places, 3), np.array_split(t, 3), np.array_split(buttons, 3))]
        np.testing.assert_array_equal(np.concatenate([h.forces for h in halves]), ticks.forces)
        self.assertEqual(again.state_hash, chain.state_hash)
        again.reset()
        self.assertEqual(again.ticks, 0)

    def test_an_array_is_felt(self):
        chain = catena.Chain({"chain": [{"name": "skin", "type": "isosurface", "field": "height", "level": 26, "free": "above"}],
                              "workspace": {"metres_per_unit": 0.01}}, fields={"height": np.mgrid[:33, :33, :33][0]})
        far, near = chain.step([16.2, 16.3, 28]), chain.step([16.2, 16.3, 25])
        self.assertEqual(catena.STATUSES[far.statuses[0, 0]], "FREE")
        np.testing.assert_array_equal(far.forces, 0)
        np.testing.assert_allclose(near.proxies[0, -1], [16.2, 16.3, 26], atol=1e-6)
        np.testing.assert_allclose(near.forces, [[0, 0, 500 * 0.01]], atol=1e-5)

    def test_ticks_go_on_from_the_time_of_the_last_one(self):
        chain = catena.Chain({}, rate_hz=500)
        np.testing.assert_allclose(chain.run([[0, 0, 0]] * 3).t, [0, 0.002, 0.004])
        chain.run([[0, 0, 0]] * 2, t=[3, 4])
        np.testing.assert_allclose(chain.run([[0, 0, 0]] * 2).t, [4.002, 4.004])
        with self.assertRaises(catena.Error):
            chain.run([[0, 0, 0]], t=[4])

    def test_what_is_masked_is_no_voxel_of_a_scene_s_field(self):
        chain = {"chain": [{"name": "skin", "type": "isosurface", "field": "f", "level": 3, "free": "above"}]}
        values = np.where(np.arange(17) < 10, np.abs(np.arange(17) - 8), -1)[:, None, None] * np.ones((17, 17, 17))
        masked = np.ma.masked_less(values, 0)
        path = np.linspace([8, 8, 1], [8, 8, 15], 200)
        np.testing.assert_array_equal(catena.Chain(chain, fields={"f": masked}).run(path).forces,
                                      catena.Chain(chain, fields={"f": catena.field(masked)}).run(path).forces)

    def test_numpy_s_numbers_are_a_scene_s(self):
        link = {"name": "skin", "type": "isosurface", "field": "f", "level": np.float32(1.5), "free": "above"}
        self.assertEqual(catena.Chain({"chain": [link]}, fields={"f": ball(9)}).links, ["skin"])

    def test_threads_that_share_a_chain_wait_for_each_other(self):
        chain = catena.Chain(SOURCE + "/assets/scenes/first.json")
        places = np.tile(self.probe("first")[1], (3, 1))
        def work():
            for _ in range(4):
                chain.run(places)
                chain.reset()
        workers = [threading.Thread(target=work) for _ in range(4)]
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()
        chain.reset()
        self.assertEqual(chain.run(places[:5]).forces.shape, (5, 3))
        self.assertEqual(chain.ticks, 5)

    def test_others_run_while_the_chain_does(self):
        chain = catena.Chain(SOURCE + "/assets/scenes/first.json")
        places = np.tile(self.probe("first")[1], (20, 1))
        worker = threading.Thread(target=chain.run, args=(places,))
        turns = 0
        worker.start()
        while worker.is_alive():
            turns += 1
            time.sleep(0)
        worker.join()
        self.assertGreater(turns, 10)  # with the lock held there would be one or two


class Pictures(unittest.TestCase):
    def test_colour_depth_and_ids_say_the_same(self):
        scene = {"isosurfaces": [{"field": "ball", "level": 10, "color": [1, 0, 0]}], "background": [0, 0, 1],
                 "camera": {"position": [16, 16, 100], "target": [16, 16, 16], "up": [0, 1, 0]}}
        p = catena.render(scene, 96, 64, fields={"ball": ball()})
        self.assertEqual((p.color.shape, p.color.dtype), ((64, 96, 4), np.uint8))
        self.assertEqual((p.depth.dtype, p.ids.dtype), (np.float32, np.uint32))
        self.assertEqual(p.objects[int(p.ids[32, 48])], ("isosurface", "ball"))
        self.assertAlmostEqual(float(p.depth[32, 48]), 84 - 10, delta=0.2)
        self.assertEqual(p.ids[0, 0], 0)
        self.assertTrue(np.isinf(p.depth[0, 0]))
        np.testing.assert_array_equal(p.color[0, 0], [0, 0, 255, 255])
        self.assertGreater(p.color[32, 48, 0], p.color[32, 48, 2])
        with tempfile.TemporaryDirectory() as folder:
            p.save(f"{folder}/p.png")
            self.assertEqual(os.listdir(folder), ["p.png"])
            with open(f"{folder}/p.png", "rb") as file:
                self.assertEqual(file.read(4), b"\x89PNG")

    def test_an_array_alone_is_shown(self):
        p = catena.render(ball(), 64, 48)
        self.assertTrue((p.color != p.color[0, 0]).any())


class Measurements(unittest.TestCase):
    """They equal the numbers of `catena measure`, of files and of arrays."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        rng = np.random.default_rng(5)
        self.labels, self.values = rng.integers(0, 3, (7, 8, 9)), rng.random((7, 8, 9)).astype(np.float32)
        self.values[2, 3, 4] = np.nan
        self.map, self.data = f"{folder.name}/map.nii", f"{folder.name}/data.nii"
        for path, kind, array in (self.map, 2, self.labels.astype(np.uint8)), (self.data, 16, self.values):
            header = bytearray(352)
            struct.pack_into("<i", header, 0, 348)
            struct.pack_into("<4h", header, 40, 3, 9, 8, 7)
            struct.pack_into("<2h", header, 70, kind, array.itemsize * 8)
            struct.pack_into("<4f", header, 76, 1, 2, 0.5, 1.5)
            struct.pack_into("<f", header, 108, 352)
            header[344:348] = b"n+1\0"
            with open(path, "wb") as file:
                file.write(bytes(header) + array.tobytes())
        with open(f"{folder.name}/map.txt", "w", encoding="utf-8") as file:
            file.write("1 Left\n")

    def told(self, *arguments):
        done = run("measure", *arguments, "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)

    def expect_equal(self, found, told, columns):
        for column in columns:
            np.testing.assert_array_equal(found[column], np.array([np.nan if row[column] is None else row[column] for row in told["rows"]]),
                                          column)
        np.testing.assert_array_equal(found["center"] if "center" in found else found["points"],
                                      [[row[c] for c in "xyz"] for row in told["rows"]])

    def test_labels(self):
        columns = "label", "voxels", "volume", "surface", "valued_voxels", "mean", "deviation", "min", "max"
        told = self.told(self.map, "--values", self.data)
        of_files = catena.measure_labels(self.map, pathlib.Path(self.data))
        self.expect_equal(of_files, told, columns)
        self.assertEqual(of_files["name"].tolist(), ["Left", ""])
        self.assertEqual(of_files["voxels"][0], (self.labels == 1).sum())
        self.assertEqual(of_files["unlabeled_voxels"], told["unlabeled_voxels"])
        self.expect_equal(catena.measure_labels(self.labels, self.values, spacing=(2, 0.5, 1.5)), told, columns)
        self.assertNotIn("mean", catena.measure_labels(self.labels))

    def test_parts(self):
        told = self.told(self.data, "--level", "0.8", "--parts", "3", "--neighbors", "6")
        for data in self.data, self.values:
            spacing = None if data is self.data else (2, 0.5, 1.5)
            found = catena.measure_parts(data, 0.8, parts=3, neighbors=6, spacing=spacing)
            self.assertEqual(found["part"].tolist(), [1, 2, 3, 0])
            self.expect_equal(found, told, ("voxels", "volume", "surface", "closed", "valued_voxels", "mean", "deviation", "min", "max"))
            for name in "parts", "voxels_above", "volume_above", "isosurface_area", "open_edges", "not_finite_voxels":
                self.assertEqual(found[name], told[name], name)

    def test_histogram_profile_and_points(self):
        found = catena.histogram(self.data, 5)
        counts, edges = np.histogram(self.values[np.isfinite(self.values)].astype(float), 5)
        np.testing.assert_array_equal(found["counts"], counts)
        np.testing.assert_allclose(found["edges"], edges, rtol=1e-15)
        self.assertEqual(found["mean"], self.told(self.data, "--histogram", "5")["mean"])
        self.assertEqual(catena.histogram(self.values, 2, range=(0.25, 0.5))["below"], (self.values < 0.25).sum())
        told = self.told(self.data, "--line", "0,0,0:16,4,12", "--samples", "33")
        line = catena.profile(self.values, (0, 0, 0), (16, 4, 12), 33, spacing=(2, 0.5, 1.5))
        self.assertTrue(np.isnan(line["values"]).any())
        self.expect_equal({**line, "value": line["values"]}, told, ("length", "value"))
        at = catena.values_at(self.data, [[2, 0.5, 1.5], [-9, 0, 0], [8, 1.5, 3]])
        np.testing.assert_array_equal(at, [self.values[1, 1, 1], np.nan, np.nan])
        self.assertEqual(catena.values_at(np.ones((3, 3, 3, 3)), [[1, 1, 1]]).tolist(), [[1, 1, 1]])

    def test_what_cannot_be_measured_is_one_line(self):
        for call, line in ((lambda: catena.measure_labels(self.values), "a label map"),
                           (lambda: catena.measure_labels(self.map, spacing=(1, 1, 1)), "its own spacing"),
                           (lambda: catena.measure_parts(self.values, 7), "no voxel reaches the level 7"),
                           (lambda: catena.measure_parts(self.values, 0.5, neighbors=18), "neighbors is 18"),
                           (lambda: catena.measure_parts(catena.analytic("sphere"), 0.5), "data is a formula"),
                           (lambda: catena.histogram(self.values, 0), "bins is 0"),
                           (lambda: catena.profile(self.values, (0, 0, 0), (1, 1, 1), 1), "samples is 1"),
                           (lambda: catena.values_at(self.values, [[0, 0, 0]], spacing=(1, 0, 1)), "three positive lengths")):
            with self.assertRaisesRegex(catena.Error, line):
                call()


class Tables(unittest.TestCase):
    def test_a_recording_is_what_was_felt(self):
        with tempfile.TemporaryDirectory() as folder:
            log = f"{folder}/a.catlog"
            done = run("feel", SOURCE + "/assets/scenes/first.json", "--device", "recorded:" + SOURCE + "/assets/probes/first.csv", "--ticks", "50",
                       "--record", log)
            if done.returncode != 0:
                done = run("feel", SOURCE + "/assets/scenes/first.json", "--device", "simulated", "--seconds", "0.05", "--record", log)
            self.assertEqual(done.returncode, 0, done.stderr)
            r = catena.recording(log)
            n = len(r["t"])
            self.assertGreater(n, 5)
            self.assertEqual(r["links"], ["curve", "skin"])
            self.assertEqual((r["probe"].shape, r["proxies"].shape, r["statuses"].shape), ((n, 3), (n, 2, 3), (n, 2)))
            self.assertIn("ends cleanly", r["ending"])
            self.assertEqual(r["version"], catena.__version__)
            with self.assertRaises(catena.Error):
                catena.recording(SOURCE + "/README.md")


    def test_a_study_s_table_has_a_row_a_trial(self):
        with tempfile.TemporaryDirectory() as folder:
            done = run("study", "simulate", SOURCE + "/assets/studies/proxy-chain.json", "--subjects", "1", "-o", folder)
            self.assertEqual(done.returncode, 0, done.stderr)
            table = catena.study_table(folder)
            self.assertTrue(table["simulated"])
            self.assertEqual(table["end_mm"].shape, (len(table["time_s"]), 3))
            self.assertEqual(set(table["subject"]), {1})
            self.assertEqual(table["condition"].dtype.kind, "U")


    def test_a_trade_report_keeps_its_columns(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(run("tradeoff", "--figure", "2", "-o", folder).returncode, 0)
            drift = catena.trade_report(folder)["figure2-drift"]
            with open(folder + "/figure2-drift.csv", encoding="utf-8") as file:
                self.assertEqual(",".join(drift.dtype.names), file.readline().strip())
            lap = dict(zip(drift["method"], drift["drift_mm_first_lap"]))
            self.assertGreater(abs(lap["linear"]), 1e3 * abs(lap["selected"]))


class Windows(unittest.TestCase):
    def test_an_array_and_a_scene_are_shown(self):
        code = ("import numpy as np, catena\n"
                "a = np.mgrid[:9, :9, :9][0]\n"
                "print(catena.show(a, options=['--frames', '2']))\n"
                "scene = {'isosurfaces': [{'field': 'height', 'level': 4}]}\n"
                "done = catena.show(scene, fields={'height': a}, options=['--frames', '2', '--size', '200x150'])\n"
                "print(done['changed'], '\"level\": 4' in done['scene'])\n"
                "try: catena.show({'isosurfaces': [{'field': 'none', 'level': 4}]})\n"
                "except catena.Error as error: print(error)\n")
        done = subprocess.run(["sh", SOURCE + "/tests/support/on_display.sh", "640x480x24", os.sys.executable, "-c", code], capture_output=True,
                              text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        lines = done.stdout.strip().splitlines()
        self.assertEqual(lines[0], "{'scene': None, 'changed': False}")
        self.assertEqual(lines[1], "False True")
        self.assertIn('unknown field "none"', lines[2])


class Pages(unittest.TestCase):
    """catena.serve, as a notebook uses it, without one."""

    def get(self, address):
        # browsers know localhost on machines without a list of names, too
        with urllib.request.urlopen(address.replace("localhost", "127.0.0.1"), timeout=20) as answer:
            return answer.headers, answer.read().decode()

    def has_ended(self, address):
        for _ in range(400):
            try:
                urllib.request.urlopen(address, timeout=20).close()
            except urllib.error.URLError:
                return True
            except ConnectionError:
                pass  # the server ended while it answered: the next attempt finds nobody
            time.sleep(0.05)
        return False

    def test_an_array_is_served_as_a_frame_of_the_notebook(self):
        with tempfile.TemporaryDirectory() as runtime:
            with open(f"{runtime}/jpserver-77.json", "w", encoding="utf-8") as file:
                json.dump({"url": "http://localhost:8888/", "pid": 77}, file)
            with unittest.mock.patch.dict(os.environ, JPY_PARENT_PID="77", JUPYTER_RUNTIME_DIR=runtime):
                served = catena.serve(ball(9), size=(320, 200))
        with served:
            self.assertTrue(served.running)
            self.assertRegex(served.url, r"^http://localhost:[0-9]+/\?token=[0-9a-f]{32}$")
            frame = re.fullmatch(r'<iframe src="([^"]*)" width="320" height="200" [^>]*></iframe><div .*>Does it stay empty\?.* at '
                                 r'http://localhost alone .*<a href="([^"]*)" .*</div>', served._repr_html_())
            self.assertEqual(frame.group(1), frame.group(2))
            headers, page = self.get(html.unescape(frame.group(1)))
            self.assertIn("frame-ancestors http://localhost:8888", headers["Content-Security-Policy"])
            self.assertIn("HttpOnly", headers["Set-Cookie"])
            self.assertIn("<canvas", page)
            with self.assertRaises(urllib.error.HTTPError):
                self.get(served.url.split("?")[0])
        self.assertFalse(served.running)
        self.assertNotIn("iframe", served._repr_html_())
        self.assertTrue(self.has_ended(served.url))
        served.stop()

    def test_files_of_a_scene_are_those_of_this_program_s_folder(self):
        before = os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            try:
                np.save("height.npy", np.mgrid[:9, :9, :9][0])
                scene = {"fields": {"f": {"file": pathlib.Path("height.npy")}}, "isosurfaces": [{"field": "f", "level": 4}]}
                self.assertEqual(catena.render(scene, 8, 6).color.shape, (6, 8, 4))
                with catena.serve(scene) as served:
                    self.assertTrue(served.running)
            finally:
                os.chdir(before)
        # all keys of a scene that name files are known
        with open(SOURCE + "/docs/reference/scene.md", encoding="utf-8") as file:
            self.assertEqual(set(re.findall(r"^\| `(\w+)` \| file \|", file.read(), re.M)), set(catena._FILES))

    def test_what_a_killed_program_left_is_removed(self):
        with tempfile.TemporaryDirectory() as folder, unittest.mock.patch.object(tempfile, "tempdir", folder):
            kept = catena._Folder()
            for name in "left", "young":
                os.mkdir(f"{folder}/catena-python-{name}")
            for path in f"{folder}/catena-python-left", kept.name:
                os.utime(path, (1, 1))
            with catena._Folder() as new:
                self.assertEqual(set(os.listdir(folder)), {os.path.basename(kept.name), os.path.basename(new), "catena-python-young"})
            self.assertFalse(os.path.exists(new))
            kept.cleanup()

    def test_what_cannot_be_served_is_the_program_s_line(self):
        with self.assertRaises(catena.Error) as caught:
            catena.serve({"isosurfaces": [{"field": "none", "level": 4}]})
        self.assertIn('unknown field "none"', str(caught.exception))
        with self.assertRaises(catena.Error):
            catena.serve(ball(9), page="file:///etc")

    def test_it_ends_with_its_program_however_that_ends(self):
        code = ("import os, signal, catena, numpy as np\n"
                "served = catena.serve(np.mgrid[:9, :9, :9][0])\n"
                "print(served.url, flush=True)\n"
                "if {how}: os.kill(os.getpid(), signal.SIGKILL)\n")
        for how in (True, False):
            done = subprocess.run([os.sys.executable, "-c", code.format(how=how)], capture_output=True, text=True, timeout=100, check=False)
            self.assertTrue(done.stdout.startswith("http://127.0.0.1:"), done.stderr)
            self.assertTrue(self.has_ended(done.stdout.strip()))


class Words(unittest.TestCase):
    def test_the_example_of_measuring_runs(self):
        with open(SOURCE + "/docs/user/measuring.md", encoding="utf-8") as file:
            code = file.read().split("```python\n")[1].split("```")[0]
        names = {}
        exec(compile(code, "measuring.md", "exec"), names)  # pylint: disable=exec-used
        self.assertAlmostEqual(names["parts"]["enclosed_volume"], 4 / 3 * np.pi * 9.5 ** 3, delta=40)
        self.assertEqual(names["labels"]["volume"][0], 2 * names["labels"]["voxels"][0])
        self.assertEqual(names["line"]["values"].shape, (100,))

    def test_the_document_s_example_runs(self):
        with open(SOURCE + "/docs/user/library.md", encoding="utf-8") as file:
            code = file.read().split("```python\n")[1].split("```")[0]
        before = os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            try:
                names = {}
                exec(compile(code, "library.md", "exec"), names)  # pylint: disable=exec-used
            finally:
                os.chdir(before)
        self.assertEqual(names["ticks"].proxies.shape, (1000, 1, 3))
        self.assertGreater(np.abs(names["ticks"].forces).max(), 1)

    def test_every_public_name_is_described(self):
        for name in catena.__all__:
            thing = getattr(catena, name)
            if name == "STATUSES":
                continue
            self.assertTrue(thing.__doc__, name)
            for member, value in inspect.getmembers(thing) if inspect.isclass(thing) and not issubclass(thing, Exception) else []:
                if not member.startswith("_"):
                    self.assertTrue(value.__doc__, f"{name}.{member}")


if __name__ == "__main__":
    unittest.main()
