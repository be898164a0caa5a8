"""The module as its users call it. Run: python3 -m unittest, with PYTHONPATH=<build>/python."""
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import unittest

import h5py
import numpy as np
import scipy.sparse as sparse

import ballast
import judge_twin

program = os.environ.get("BALLAST_PROGRAM", "")
if not os.path.exists(program):
    program = ""
needs_program = unittest.skipUnless(program, "BALLAST_PROGRAM names no program")
examples = pathlib.Path(__file__).resolve().parent.parent / "examples"


def run(*words):
    """The program; its words are in the exception when it fails."""
    done = subprocess.run([program, *words], capture_output=True, text=True)
    if done.returncode != 0:
        raise AssertionError(done.stderr)


def chain(n, seed=1):
    """n points of 1 kg in a row between walls: M, H, mu, v_free; W has rank 3n of 3n + 3."""
    H = sparse.lil_matrix((3 * n + 3, 3 * n))
    for c in range(n + 1):
        for k in range(3):
            if c < n:
                H[3 * c + k, 3 * c + k] = 1.0
            if c > 0:
                H[3 * c + k, 3 * c - 3 + k] = -1.0
    v = np.random.default_rng(seed).normal(size=3 * n)
    return sparse.identity(3 * n), H.tocsr(), np.full(n + 1, 0.4), v


class Problems(unittest.TestCase):
    def test_ctrl_c_ends_a_solve(self):
        M, H, mu, v = chain(40)
        problem = ballast.Problem.from_bodies(M, H, mu, v_free=v)
        for solver in "pgs", "newton_burst":
            timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
            timer.start()
            with self.assertRaises(KeyboardInterrupt):
                for _ in range(10**6):
                    ballast.solve(problem, solver, tolerance=0.0, max_iterations=10**9)
            timer.join()

    def test_both_forms_are_the_same_problem(self):
        M, H, mu, v = chain(12)
        bodies = ballast.Problem.from_bodies(M, H, mu, v_free=v)
        W = (H @ H.T).tocsr()
        stored = ballast.Problem.from_delassus(W, H @ v, mu)
        self.assertTrue(bodies.has_bodies)
        self.assertFalse(stored.has_bodies)
        np.testing.assert_allclose(bodies.W.toarray(), W.toarray(), atol=1e-14)
        np.testing.assert_allclose(bodies.q.ravel(), H @ v, atol=1e-14)
        answer = ballast.solve(bodies, tolerance=1e-10)
        self.assertTrue(answer.solved, answer.words)
        self.assertLess(ballast.judge(stored, answer.impulses)["natural_map_rms"], 1e-8)
        np.testing.assert_allclose(answer.body_velocities,
                                   v + H.T @ answer.impulses.ravel(), atol=1e-12)
        np.testing.assert_allclose(answer.velocities.ravel(), H @ answer.body_velocities,
                                   atol=1e-12)
        self.assertEqual(answer.history.shape[1], 3)

    def test_known_answer(self):
        q = [[-1, 0, 0], [-1, 2, 0]]
        problem = ballast.Problem.from_delassus(np.eye(6), np.array(q, dtype=int), [0.5, 0.5])
        answer = ballast.solve(problem, "pgs", tolerance=1e-12)
        np.testing.assert_allclose(answer.impulses, [[1, 0, 0], [1, -0.5, 0]], atol=1e-10)
        again = ballast.solve(problem, "pgs", tolerance=1e-12, start=answer.impulses)
        self.assertEqual(again.iterations, 0)

    def test_bad_input_is_an_exception_of_one_line(self):
        make, bodies = ballast.Problem.from_delassus, ballast.Problem.from_bodies
        eye, q = np.eye(3), np.array([-1.0, 0, 0])
        up = np.array([[0.0, 3, 0], [0, 0, 0], [0, 0, 0]])

        def solve(**settings):
            return ballast.solve(make(eye, q, [0.5]), "pgs", **settings)

        cases = [
            (ValueError, "q has 3 entries, must have 6", lambda: make(np.eye(6), q, [0.5, 0.5])),
            (ValueError, "W: is 6 x 6, must be 3 x 3", lambda: make(np.eye(6), q, [0.5])),
            (ValueError, "W: is 3 x 2, must", lambda: make(np.ones((3, 2)), q, [0.5])),
            (ballast.InvalidProblem, "delassus.q[0] = nan", lambda: make(eye, q * np.nan, [0.5])),
            (ballast.InvalidProblem, "delassus.w(0, 0) = nan",
             lambda: make(eye * np.nan, q, [0.5])),
            (ballast.InvalidProblem, "friction[0] = -0.5 is negative",
             lambda: make(eye, q, [-0.5])),
            (ballast.InvalidProblem, "friction[0] = nan", lambda: make(eye, q, [np.nan])),
            (ballast.InvalidProblem, "is negative", lambda: make(-eye, q, [0.5])),
            (ballast.InvalidProblem, "delassus.w(", lambda: make(eye + up, q, [0.5])),
            (ballast.InvalidProblem, "not positive definite",
             lambda: bodies(-eye, eye, [0.5], v_free=q)),
            (ballast.InvalidProblem, "dynamics.mass[", lambda: bodies(eye + up, eye, [0.5], f=q)),
            (ballast.InvalidProblem, "not positive definite",
             lambda: bodies(eye + up + up.T, eye, [0.5], f=q)),
            (ValueError, "M: is 3 x 3, must be 2 x 2", lambda: bodies(eye, eye, [0.5], f=q[:2])),
            (ValueError, "M: is 3 x 3, must be 4 x 4",
             lambda: bodies(eye, eye, [0.5], v_free=np.ones(4))),
            (ValueError, "H: is 3 x 2, must be 3 x 3",
             lambda: bodies(eye, eye[:, :2], [0.5], f=q)),
            (ballast.InvalidProblem, "nan", lambda: bodies(eye, eye * np.nan, [0.5], f=q)),
            (ValueError, "mu: has the shape (1, 2)", lambda: bodies(eye, eye, [[0.5, 0.5]], f=q)),
            (ValueError, "mu: has the shape (1, 2)", lambda: make(eye, q, [[0.5, 0.5]])),
            (ValueError, "mu: has the shape ()", lambda: make(eye, q, 0.5)),
            (ValueError, "expected one of", lambda: bodies(eye, eye, [0.5])),
            (ballast.Error, "no such file", lambda: ballast.Problem.read("nothing.hdf5")),
            (ballast.UnknownSolver, "no solver is called",
             lambda: ballast.solve(make(eye, q, [0.5]), "psg")),
            (ValueError, "r has 4 entries", lambda: ballast.judge(make(eye, q, [0.5]), np.ones(4))),
            (ValueError, "complex", lambda: make(eye * 1j, q, [0.5])),
            (ValueError, "complex", lambda: solve(start=q * 1j)),
            (ValueError, "complex", lambda: ballast.judge(make(eye, q, [0.5]), q * 1j)),
            (ValueError, "start has 4 entries", lambda: solve(start=np.ones(4))),
            (ValueError, "complex", lambda: bodies(eye, eye, [0.5], f=q * 1j)),
            (ValueError, "tolerance: expected", lambda: solve(tolerance=-1)),
            (ValueError, "tolerance: expected", lambda: solve(tolerance=np.nan)),
            (ValueError, "max_iterations: expected", lambda: solve(max_iterations=-1)),
            (ValueError, "max_seconds: expected", lambda: solve(max_seconds=np.nan)),
            (ValueError, "count: expected", lambda: ballast.Scene("sliding_cube").step(-1)),
            (ballast.Error, "no scene of this name", lambda: ballast.Scene("zeno_bal")),
            (TypeError, "expected a list", lambda: ballast.Scene("zeno_ball", "scene.step=1e-3")),
            (ValueError, "floor: does not move",
             lambda: ballast.Scene("sliding_cube").set_force("floor", [1, 0, 0])),
            (RuntimeError, "no step has been made", lambda: ballast.Scene("sliding_cube").problem),
        ]
        for kind, words, call in cases:
            with self.subTest(words), self.assertRaises(kind) as caught:
                call()
            self.assertIn(words.lower(), str(caught.exception).lower())
            self.assertNotIn("\n", str(caught.exception))

    def test_masses_that_are_none_are_refused_without_bodies_too(self):
        M, H = np.full((7, 7), 0.1) + np.eye(7), np.eye(7)[[0, 1, 6]]
        ballast.Problem.from_bodies(M, H, [[0.5]], f=-np.ones(7))
        for entry, words in (np.inf, "not finite"), (5.0, "not positive definite"):
            M[0, 6] = M[6, 0] = entry
            with self.assertRaisesRegex(ballast.InvalidProblem, words):
                ballast.Problem.from_bodies(M, H, [0.5], f=-np.ones(7))

    def test_indices_are_checked_before_scipy_believes_them(self):
        eye, f = np.eye(3), np.ones(3)
        for form in "csr", "csc", "bsr", "coo", "lil":
            bad = sparse.csr_matrix(eye).asformat(form)
            ballast.Problem.from_delassus(bad, f, [0.5])
            if form == "lil":
                bad.rows[2] = [10**6]
            elif form == "coo":
                bad.row = np.array([0, 1, 10**6], dtype=np.int32)
            else:
                bad.indices = np.array([0, 1, 10**6], dtype=np.int32)
            for make in [lambda: ballast.Problem.from_delassus(bad, f, [0.5]),
                         lambda: ballast.Problem.from_bodies(bad, eye, [0.5], f=f),
                         lambda: ballast.Problem.from_bodies(eye, bad, [0.5], f=f)]:
                with self.subTest(form), self.assertRaisesRegex(ValueError, "[WMH]: .* index"):
                    make()

    def test_a_path_may_have_any_bytes(self):
        with tempfile.TemporaryDirectory() as folder:
            odd = pathlib.Path(folder, os.fsdecode(b"caf\xe9.toml"))
            with self.assertRaisesRegex(ballast.Error, "caf\udce9.toml: no such"):
                ballast.Scene(odd)
            source = pathlib.Path(__file__).resolve().parents[2] / "problems/scenes"
            shutil.copy(source / "sliding_cube.toml", odd)
            self.assertIn("cube", ballast.Scene(odd).names)

    def test_python_may_end_while_threads_solve_and_step(self):
        for work in ["ballast.solve(problem, 'pgs', tolerance=0.0, max_iterations=10**9)",
                     "ballast.Scene('settled_rest').step(10**9)"]:
            done = subprocess.run(
                [sys.executable, "-c", "import ballast, threading, time, numpy\n"
                 "problem = ballast.Problem.from_delassus(numpy.eye(3), [-1, 0.1, 0.3], [0.5])\n"
                 f"threading.Thread(target=lambda: {work}, daemon=True).start()\n"
                 "time.sleep(0.3)"], stderr=subprocess.PIPE, text=True)
            with self.subTest(work):
                self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_another_python_is_told_so(self):
        package = pathlib.Path(ballast.__file__).parent
        with tempfile.TemporaryDirectory() as folder:
            copy = pathlib.Path(folder, "ballast")
            shutil.copytree(package, copy, ignore=shutil.ignore_patterns("*.so"))
            # As the files of another version are called.
            copy.joinpath("_ballast.cpython-27-other.so").touch()
            told = subprocess.run([sys.executable, "-c", "import ballast"], cwd=folder, text=True,
                                  env={**os.environ, "PYTHONPATH": folder}, stderr=subprocess.PIPE)
        self.assertIn("built as _ballast.cpython-27-other.so, and this is Python", told.stderr)

    def test_other_threads_run_while_it_solves(self):
        M, H, mu, v = chain(3000)
        problem = ballast.Problem.from_bodies(M, H, mu, v_free=v)
        worker = threading.Thread(target=lambda: ballast.solve(problem, "apgd", tolerance=0.0,
                                                               max_seconds=1.0,
                                                               max_iterations=10**9))
        worker.start()
        turns = 0
        while worker.is_alive() and turns < 1000:
            worker.join(0.001)
            turns += 1
        self.assertGreater(turns, 50)
        worker.join()

    def test_large_arrays_are_not_copied(self):
        M, H, mu, v = chain(12)
        stored = ballast.Problem.from_delassus((H @ H.T).tocsr(), H @ v, mu)
        first, again = stored.W, stored.W
        self.assertTrue(np.shares_memory(first.data, again.data))
        with self.assertRaises(ValueError):
            first.data[0] = 7.0
        del stored, again
        self.assertTrue(np.all(np.isfinite(first.data)))  # the matrix keeps the problem
        bodies = ballast.Problem.from_bodies(2 * M, H, mu, v_free=v)
        np.testing.assert_array_equal(bodies.M.toarray(), 2 * M.toarray())
        np.testing.assert_array_equal(bodies.H.toarray(), H.toarray())
        np.testing.assert_allclose(bodies.f, 2 * v, rtol=1e-15)
        with self.assertRaisesRegex(ValueError, "there are no bodies"):
            ballast.Problem.from_delassus(np.eye(3), [0, 0, 0], [0.1]).M

    @needs_program
    def test_same_bits_as_the_program(self):
        M, H, mu, v = chain(20)
        with tempfile.TemporaryDirectory() as folder:
            file, out = folder + "/p.hdf5", folder + "/r.hdf5"
            problem = ballast.Problem.from_bodies(M, H, mu, v_free=v)
            problem.write(file)
            with self.assertRaisesRegex(ValueError, "only .hdf5 and .h5"):
                problem.write(folder + "/p.dat")
            for solver in ["pgs", "nncg", "newton_ac", "auto"]:
                with self.subTest(solver):
                    run("solve", file, "--solver", solver, "--tolerance", "1e-8", "--output", out)
                    answer = ballast.solve(ballast.Problem.read(file), solver, tolerance=1e-8)
                    stored = ballast._ballast.dataset(out, "/solution/r")
                    self.assertEqual(stored.tobytes(), answer.impulses.tobytes())


class Scenes(unittest.TestCase):
    def test_state_is_a_view_and_steps(self):
        scene = ballast.Scene("sliding_cube")
        x, v = scene.positions, scene.velocities
        before = x.copy()
        record = scene.step(10)
        self.assertAlmostEqual(scene.time, 10 * scene.h)
        self.assertTrue(np.any(x != before))
        self.assertTrue(np.shares_memory(x, scene.positions))
        v[0] = [0.5, 0.0, 0.0]
        self.assertEqual(scene.velocities[0, 0], 0.5)
        self.assertIn("contacts", record)
        self.assertEqual(len(scene.problem), len(scene.impulses))
        del scene
        self.assertTrue(np.all(np.isfinite(x)))  # the array keeps the scene

    def test_a_step_that_fails_leaves_a_scene_that_says_so(self):
        scene = ballast.Scene("sliding_cube")
        scene.set_force("cube", [1e34, 0, 0])
        for _ in range(3):
            with self.assertRaises(Exception):
                scene.step()
        for part in "problem", "impulses":
            with self.assertRaisesRegex(RuntimeError, "the last step failed"):
                getattr(scene, part)
        self.assertTrue(len(scene.names) > 0)

    def test_threads_that_step_one_scene_wait_for_each_other(self):
        scene = ballast.Scene("settled_rest")
        scene.step()
        threads = [threading.Thread(target=scene.step, args=(100,)) for _ in range(2)]
        for thread in threads:
            thread.start()
        for _ in range(20):
            self.assertTrue(np.all(np.isfinite(scene.impulses)))
        for thread in threads:
            thread.join()
        self.assertAlmostEqual(scene.time, 201 * scene.h)

    def test_callback_ends_the_stepping(self):
        scene, times = ballast.Scene("sliding_cube"), []
        scene.step(100, lambda s, record: times.append(s.time) or len(times) < 7)
        self.assertEqual(len(times), 7)
        scene.step(100, lambda s, record: times.append(s.time))
        scene.step(100, lambda s, record: times.append(s.time) or np.bool_(len(times) < 110))
        self.assertEqual(len(times), 110)
        with self.assertRaisesRegex(ValueError, "truth value"):
            scene.step(3, lambda s, record: np.ones(2))
        with self.assertRaises(ZeroDivisionError):
            scene.step(3, lambda s, record: 1 / 0)


    def test_grains_have_the_bits_of_a_run(self):
        """Also what a run leaves: its record and its captured problems."""
        words = ["grains.count=12", "scene.duration=0.01", "record.pose_rate=1000"]
        with tempfile.TemporaryDirectory() as folder:
            packings, output = folder + "/packings", folder + "/run"
            scene = ballast.Scene("vibrated_box_small", words, packings=packings)
            if not program:
                self.skipTest("BALLAST_PROGRAM names no program")
            run("run", "vibrated_box_small", "--output", output, "--packing-cache", packings,
                "--quiet", "--no-report", "--capture", "from=2,to=3",
                *[word for setting in words for word in ("--set", setting)])
            record = ballast.Record(output)
            self.assertEqual(record.bodies, scene.names)
            steps = record.steps
            for k in range(len(steps["time"])):
                made = scene.step()
                for column in ["wall_x", "contacts", "error_rms"]:
                    self.assertEqual(made[column], steps[column][k])
            self.assertEqual(record["poses/position"].shape[1:], scene.positions.shape)
            self.assertEqual(record["poses/position"][-1].tobytes(), scene.positions.tobytes())
            captured = [ballast.Captured.read(file)
                        for file in sorted(pathlib.Path(output, "capture").iterdir())]
            self.assertEqual([c.step for c in captured], [2, 3])
            n = len(captured[1].problem)
            self.assertEqual(captured[1].frame.shape, (n, 3, 3))
            self.assertEqual(captured[1].bodies.shape, (n, 2))
            self.assertLess(ballast.judge(captured[1].problem, captured[1].solution)
                            ["natural_map_rms"], captured[1].velocity_scale)
            for file in sorted(pathlib.Path(output, "capture").iterdir()):
                r = 0.9 * ballast.Captured.read(file).solution
                self.assertLess(judge_twin.largest_difference(file, r), 1e-9)
            with self.assertRaisesRegex(ballast.Error, "no such dataset"):
                record["steps/colour"]


class Comparisons(unittest.TestCase):
    @needs_program
    def test_own_solver_is_a_row_and_a_curve(self):
        own = "own=%s %s" % (sys.executable, examples / "own_solver.py")
        with tempfile.TemporaryDirectory() as folder:
            listed = pathlib.Path(folder, "list.toml")
            listed.write_text('[[external]]\nname = "served"\nserve = true\ncommand = "%s %s"\n'
                              % (sys.executable, examples / "own_solver.py"))
            run("compare", "known:contacts=8,bodies=6", "--solvers", "pgs", "--tolerances", "1e-4",
                "--no-report", "--memory", "0", "--output", folder + "/out", "--external", own,
                "--external", str(listed))
            rows = {row["solver"]: row for row in ballast.rows(folder + "/out")}
            for name in ["own", "served"]:
                self.assertEqual(rows[name]["verdict"], "solved", rows[name]["note"])
                self.assertGreater(len(rows[name]["history"]), 1)
                self.assertGreater(rows[name]["iterations"], 0)
        with self.assertRaisesRegex(ballast.Error, "it has no rows"):
            ballast.rows("/nowhere")

    def test_what_a_solver_may_not_answer(self):
        M, H, mu, v = chain(3)
        with tempfile.TemporaryDirectory() as folder:
            ballast.Problem.from_bodies(M, H, mu, v_free=v).write(folder + "/p.hdf5")
            with self.assertRaisesRegex(ballast.Error, "is no request"):
                ballast.serve(lambda request: request.start, [folder + "/p.hdf5", folder + "/a"])
            with self.assertRaisesRegex(SystemExit, "expected PROBLEM ANSWER"):
                ballast.serve(lambda request: request.start, ["--surve"])
            request, answer = folder + "/p.hdf5", folder + "/answer.hdf5"
            with h5py.File(request, "a") as file:
                for name, value in [("protocol", 1), ("id", 3), ("tolerance", 1e-6),
                                    ("fclib_tolerance", 0.0), ("max_iterations", 77),
                                    ("max_seconds", 1.0), ("start", np.zeros(12))]:
                    file["ballast_request/" + name] = np.atleast_1d(value)

            def serve(**parts):
                ballast.serve(lambda asked: {"impulses": asked.start, **parts}, [request, answer])

            with self.assertRaisesRegex(ValueError, "complex"):
                serve(impulses=np.ones((4, 3)) * 1j)
            with self.assertRaisesRegex(ValueError, "three numbers per point"):
                serve(history=np.zeros((3, 4)))
            serve(iterations=10**12, history=[[0, 0.0, np.nan], [1, 0.5, 1e-3]])
            written = [ballast._ballast.dataset(answer, "/ballast_answer/" + name).ravel().tolist()
                       for name in ("iterations", "history")]
            self.assertEqual(written, [[77.0], [1.0, 0.5, 1e-3]])


class Examples(unittest.TestCase):
    def test_examples_run(self):
        for name, words in [("own_problem", "solved [[1.0"), ("error_against_time", "solved"),
                            ("controlled_force", "0.2")]:
            with self.subTest(name):
                said = subprocess.run([sys.executable, str(examples / (name + ".py"))], check=True,
                                      capture_output=True, text=True).stdout
                self.assertIn(words, said)


if __name__ == "__main__":
    unittest.main()
