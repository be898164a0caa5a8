"""The judge once more, from the law alone: numpy and h5py read FCLIB's global form, nothing of
Ballast's is in it. As a program: judge_twin.py FOLDER compares both on every problem below."""
import pathlib
import sys

import h5py
import numpy as np
import scipy.sparse as sparse


def read(path):
    """M, H (bodies x contacts' rows), f, w and mu of a file: u = H' v + w, M v = f + H r."""
    with h5py.File(path) as file:
        form = file["fclib_global"]

        def matrix(name):
            part = form[name]
            rows, columns = int(part["m"][0]), int(part["n"][0])
            assert part["nz"][0] == -1, "compressed columns"
            return sparse.csc_matrix((part["x"][:], part["i"][:], part["p"][:]), (rows, columns))

        vectors = form["vectors"]
        return matrix("M"), matrix("H"), vectors["f"][:], vectors["w"][:], vectors["mu"][:]


def padded(path, r):
    """r with three rows for each contact: one without friction may have the first alone."""
    with h5py.File(path) as file:
        mu = file["fclib_global/vectors/mu"]
        rows = file["ballast/rows"][:] if "ballast/rows" in file else np.full(len(mu), 3)
    if np.size(r) == 3 * len(rows):
        return np.ravel(r)
    full = np.zeros((len(rows), 3))
    full[np.arange(3) < rows[:, None]] = np.ravel(r)
    return full.ravel()


def onto_cone(r, mu):
    """The nearest point of {r: |r_T| <= mu r_N} to each row of r."""
    normal, tangent = r[:, 0], np.linalg.norm(r[:, 1:], axis=1)
    height = np.maximum(normal + mu * tangent, 0) / (1 + mu**2)
    along = np.divide(mu * height, tangent, out=np.zeros_like(tangent), where=tangent > 0)
    outside = np.column_stack([height, along[:, None] * r[:, 1:]])
    inside = (tangent <= mu * normal) & (normal >= 0)
    return np.where(inside[:, None], r, outside)


def inverse_of(M):
    """M^-1, body by body: no entry of M joins two."""
    count, body = sparse.csgraph.connected_components(M)
    members = np.split(np.argsort(body, kind="stable"), np.cumsum(np.bincount(body))[:-1])
    blocks = [np.linalg.inv(M[rows][:, rows].toarray()) for rows in members]
    order = np.concatenate(members)
    back = sparse.csc_matrix((np.ones(len(order)), (order, np.arange(len(order)))), M.shape)
    return back @ sparse.block_diag(blocks, format="csc") @ back.T


def judge(path, r):
    """Measures of stacked impulses r, by the names of Ballast's judge."""
    M, H, f, w, mu = read(path)
    inverse = inverse_of(M.tocsr())
    u = (H.T @ (inverse @ (f + H @ r)) + w).reshape(-1, 3)
    q = H.T @ (inverse @ f) + w
    r = r.reshape(-1, 3)
    bent = u.copy()  # De Saxce's u + mu |u_T| n
    bent[:, 0] += mu * np.linalg.norm(u[:, 1:], axis=1)
    pushed = inverse @ H
    blocks = [[H[:, i::3].multiply(pushed[:, j::3]).sum(axis=0).A1 for j in range(3)]
              for i in range(3)]
    largest = np.linalg.eigvalsh(np.moveaxis(blocks, 2, 0))[:, -1]  # of W's block
    moves = largest > 0
    rho = np.divide(1, largest, out=np.zeros_like(largest), where=moves)
    natural = np.linalg.norm(r - onto_cone(r - rho[:, None] * bent, mu), axis=1) * largest
    unscaled = np.linalg.norm(r - onto_cone(r - bent, mu))
    norms = [np.linalg.norm(x) for x in (q, r, u)]
    return {"natural_map_rms": np.sqrt(np.sum(natural[moves]**2) / max(1, moves.sum())),
            "natural_map_max": natural[moves].max(initial=0),
            "fclib": unscaled / max(norms),
            "cone_violation": np.linalg.norm(r - onto_cone(r, mu), axis=1).max(),
            "min_normal_velocity": u[:, 0].min(),
            "complementarity": np.abs(np.sum(r * bent, axis=1)).max()}


def largest_difference(path, r):
    """Over the larger of the two, of all measures."""
    import ballast
    r = padded(path, r)
    ours, own = ballast.judge(ballast.Problem.read(path), r), judge(path, r)
    return max(abs(ours[name] - own[name]) / max(abs(ours[name]), abs(own[name]), 1e-14)
               for name in own)


if __name__ == "__main__":
    random, worst, count = np.random.default_rng(1), 0.0, 0
    for path in sorted(pathlib.Path(sys.argv[1]).rglob("*.hdf5")):
        with h5py.File(path) as file:
            if "fclib_global" not in file or len(file["fclib_global/vectors/w"]) == 0:
                continue  # of another form, or without contacts
            if "ballast/solution" in file:
                found = file["ballast/solution"][:]
            else:
                found = np.ones(len(file["fclib_global/vectors/w"]))
        difference = largest_difference(path, found * random.uniform(0.8, 1.2, len(found)))
        count += 1
        if difference > worst:
            worst = difference
            print(f"{difference:.1e}  {path}", flush=True)
    print(f"{count} problems, largest relative difference {worst:.1e}")
    sys.exit(bool(worst > 1e-6))
