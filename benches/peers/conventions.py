#!/usr/bin/env python3
"""What GraspIt!, Dex-Net, FRoGGeR and OpenRAVE print, recreated from their formulas, beside our conventions.

  pip install numpy scipy
  benches/peers/conventions.py [--count 200]

Each system's quality is written down here on its own, in its own units, with Qhull as the hull. Pyramids need a
first edge: FRoGGeR's own tangent (the projection of (1.2, 2.3, 3.4)) is used for FRoGGeR; the others take theirs
from the frame of a simulated finger, in whose place stands the axis least aligned with the normal. GraspIt!
divides by the largest distance of a vertex of the body; here the contacts are the body's vertices.
"""
import argparse, json, subprocess
import numpy as np
from scipy.spatial import ConvexHull, QhullError

def unit(v): return v / np.linalg.norm(v, axis=-1, keepdims=True)

def offset(points):
    """Signed distance of the nearest facet from the origin."""
    try: return -ConvexHull(points).equations[:, -1].max()
    except QhullError: return -np.inf

def projected(n, a): return unit(a - n * (a @ n))
def least_aligned(n): return projected(n, np.eye(3)[np.argmin(np.abs(n))])

def graspit(c, n, com, mu=1.0):
    radius = max(np.linalg.norm(1000 * (x - com)) for x in c); rows = []          # millimetres, as its bodies
    for x, m in zip(c, n):
        ex = least_aligned(m); ey = np.cross(m, ex)
        for j in range(8):
            f = m + mu * (np.cos(j * np.pi / 4) * ex + np.sin(j * np.pi / 4) * ey)
            rows.append([*f, *(np.cross(1000 * (x - com), f) / radius)])
    q = offset(np.array(rows)); return q if q > 0 else -1.0

def dexnet(c, n, com, mu=0.5, faces=8, torque_scaling=1000.0):
    cols = []
    for x, m in zip(c, n):
        t1 = least_aligned(m); t2 = np.cross(m, t1)
        for j in range(faces):
            f = m + mu * (t1 * np.cos(2 * np.pi * j / faces) + t2 * np.sin(2 * np.pi * j / faces))
            cols.append(np.r_[f, torque_scaling * np.cross(x - com, f)])
    return max(offset(np.array(cols)), 0.0)

def frogger(c, n, _, mu=0.7, ns=4):
    s = np.sqrt(1 / (1 + mu ** 2)); rows = []
    for x, m in zip(c, n):
        tx = projected(m, np.array([1.2, 2.3, 3.4])); R = np.stack([tx, np.cross(m, tx), m], 1)
        for j in range(ns):
            f = R @ np.array([mu * s * np.cos(2 * np.pi * j / ns), mu * s * np.sin(2 * np.pi * j / ns), s])
            rows.append(np.r_[f, np.cross(x, f)])                                   # about the object's origin
    q = offset(np.array(rows)); return q if q > 0 else -1.0

def openrave(c, n, _, mu=0.4):
    rows = []
    for x, m in zip(c, n):
        r = least_aligned(m); u = np.cross(m, r)
        for j in range(8):
            f = unit(m + mu * np.cos(2 * np.pi * j / 8) * r + mu * np.sin(2 * np.pi * j / 8) * u)
            rows.append(np.r_[f, np.cross(x, f)])
    return max(offset(np.array(rows)), 0.0)

def ours(name, cases):
    text = '\n'.join(' '.join(repr(float(x)) for x in [1, 8, 0, len(c), *c.ravel(), *n.ravel(), *z]) for c, n, z in cases)
    command = f'cargo run -q --release -p moduli-grasp --example quality_table {name}'
    run = subprocess.run(command.split(), input=text, capture_output=True, text=True)
    if run.returncode: raise SystemExit(run.stderr)
    return np.array([float(r.split()[0]) for r in run.stdout.split('\n')[:len(cases)]])

def main():
    a = argparse.ArgumentParser(); a.add_argument('--count', type=int, default=200); o = a.parse_args()
    rng = np.random.default_rng(5); cases = []
    for i in range(o.count):
        m = 3 + i % 2; t = 2 * np.pi * np.arange(m) / m
        c = 0.04 * np.stack([np.cos(t), np.sin(t), 0 * t], 1) + 0.008 * rng.normal(size=(m, 3)); n = unit(-c + 0.01 * rng.normal(size=(m, 3)))
        cases.append((c, n, 0.004 * rng.normal(size=3)))
    for name, f, about_origin in (('graspit', graspit, 0), ('dexnet', dexnet, 0), ('frogger', frogger, 1), ('openrave', openrave, 1)):
        given = [(c, n, np.zeros(3) if about_origin else z) for c, n, z in cases]
        theirs = np.array([f(*g) for g in given]); q = ours(name, given)
        edge = (theirs > 0) & (theirs < 1e-12)                   # the origin on the boundary: the sign of theirs is rounding
        print(json.dumps(dict(system=name, grasps=len(q), closed=int((theirs >= 1e-12).sum()), on_the_boundary=int(edge.sum()),
              mean=float(theirs.mean()), largest_difference=float(np.abs(q - theirs)[~edge].max()))), flush=True)

if __name__ == '__main__': main()
