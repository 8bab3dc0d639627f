#!/usr/bin/env python3
"""Epsilon quality side by side with Qhull (scipy), one thread, in one run.

  pip install numpy scipy
  benches/peers/hull.py speed   [--count 300]      closed 3-contact grasps at 8 and 16 edges, and all random ones
  benches/peers/hull.py agree   [--count 10000]    2 to 6 contacts, 3 to 24 edges, near-degenerate ones among them
  benches/peers/hull.py round   [--count 300]      round cones: cost against the width of the interval

Random grasps have contacts uniform in the ball of radius 2, inward normals uniform on the sphere, centre 0.
Both sides get the same numbers; ours runs as the example `quality_table` of the crate moduli-grasp.
"""
import argparse, json, subprocess, time
import numpy as np
from scipy.spatial import ConvexHull, QhullError

def unit(v): return v / np.linalg.norm(v, axis=-1, keepdims=True)

def random_grasp(rng, m=3):
    c = unit(rng.normal(size=(m, 3))) * 2 * rng.uniform(size=(m, 1)) ** (1 / 3)
    return c, unit(rng.normal(size=(m, 3))), np.zeros(3)

def wrenches(c, n, z, mu, k):
    a = 2 * np.pi * np.arange(k) / k; out = []
    for ci, ni in zip(c, n):
        e = np.zeros(3); e[np.argmin(np.abs(ni))] = 1
        t = unit(e - ni * (e @ ni)); b = np.cross(ni, t)
        f = ni + mu * (np.cos(a)[:, None] * t + np.sin(a)[:, None] * b)
        out.append(np.hstack([f, np.cross(ci - z, f)]))
    return np.vstack(out)

def qhull(case):
    """Qhull's value; 0 where it finds the points flat, NaN where it gives up on precision."""
    mu, k, _, c, n, z = case
    try: return max(0.0, -ConvexHull(wrenches(c, n, z, mu, k)).equations[:, -1].max())
    except QhullError as error: return 0.0 if any(x in str(error) for x in ('flat', 'less than', 'not enough')) else np.nan

def joggled(case):
    mu, k, _, c, n, z = case
    return max(0.0, -ConvexHull(wrenches(c, n, z, mu, k), qhull_options='QJ').equations[:, -1].max())

def ours(cases):
    text = '\n'.join(' '.join(repr(float(x)) for x in [mu, k, tol, len(c), *c.ravel(), *n.ravel(), *z]) for mu, k, tol, c, n, z in cases)
    run = subprocess.run('cargo run -q --release -p moduli-grasp --example quality_table'.split(), input=text, capture_output=True, text=True)
    if run.returncode: raise SystemExit(run.stderr)
    *rows, us = run.stdout.split('\n')[:-1]
    return np.array([[float(x) for x in r.split()] for r in rows]), float(us.split()[0])

def timed(cases):
    t = []
    for _ in range(3):
        a = time.perf_counter(); q = np.array([qhull(x) for x in cases]); t.append((time.perf_counter() - a) / len(cases) * 1e6)
    return q, float(np.median(t))

def closed(rng, count, k):
    out = []
    while len(out) < count:
        batch = [(1.0, k, 0.0, *random_grasp(rng)) for _ in range(20 * count)]
        q, _ = ours(batch); out += [b for b, r in zip(batch, q) if r[0] > 0]
    return out[:count]

def say(**k): print(json.dumps(k), flush=True)

def compare(name, cases, peer_cases=None):
    """Ours on all cases, Qhull on a part of them where they are many."""
    peer_cases = peer_cases or cases
    q, peer = timed(peer_cases); r, us = ours(cases)
    say(case=name, grasps=len(cases), qhull_us=round(peer, 2), ours_us=us, ratio=round(peer / us, 1),
        largest_difference=float(np.nanmax(np.abs(r[:len(q), 0] - q))))

def speed(count):
    rng = np.random.default_rng(1)
    for k in (8, 16): compare(f'closed 3x{k}', closed(rng, count, k))
    cases = [(1.0, 8, 0.0, *random_grasp(rng)) for _ in range(100000)]
    compare('random 3x8', cases, cases[:5 * count])

def agree(count):
    rng = np.random.default_rng(2); cases = []
    for i in range(count):
        m, k, mu = int(rng.integers(2, 7)), int(rng.integers(3, 25)), float(rng.uniform(0.2, 1.5)); kind = i % 4
        if kind == 0: c, n, z = random_grasp(rng, m)
        else:
            a = 2 * np.pi * np.arange(m) / m; noise = (0.3, 10.0 ** -rng.integers(3, 16), 0.0)[kind - 1]
            c = np.stack([np.cos(a), np.sin(a), 0 * a], 1); n = unit(-c + noise * rng.normal(size=(m, 3))); c = c + noise * rng.normal(size=(m, 3)); z = np.zeros(3)
            if kind == 3 and m > 3: c[-1], n[-1] = c[0], n[0]
        cases.append((mu, k, 0.0, c, n, z))
    r, us = ours(cases); q = []
    for upto in sorted({count // 4, count // 2, 3 * count // 4, count}):
        q += [qhull(x) for x in cases[len(q):upto]]; a = np.array(q); d = np.abs(r[:upto, 0] - a); refused = np.where(np.isnan(a))[0]
        against_joggled = [abs(r[i, 0] - joggled(cases[i])) for i in refused]
        say(case='agreement', grasps=upto, closed=int((r[:upto, 0] > 0).sum()), largest_difference=float(np.nanmax(d)), worst=int(np.nanargmax(d)),
            over_1e_9=int((d > 1e-9).sum()), widest=float((r[:upto, 2] - r[:upto, 1]).max()), qhull_refused=len(refused),
            largest_difference_from_joggled_there=float(max(against_joggled, default=0.0)), ours_us=us)

def round_cone(count):
    rng = np.random.default_rng(3); cases = closed(rng, count, 8)
    for tol in (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9):
        r, us = ours([(mu, 0, tol, c, n, z) for mu, _, _, c, n, z in cases])
        say(case='round', tolerance=tol, grasps=len(cases), ours_us=us, widest=float((r[:, 2] - r[:, 1]).max()))

def main():
    a = argparse.ArgumentParser(); a.add_argument('what', choices=['speed', 'agree', 'round']); a.add_argument('--count', type=int)
    o = a.parse_args()
    {'speed': lambda: speed(o.count or 300), 'agree': lambda: agree(o.count or 10000), 'round': lambda: round_cone(o.count or 300)}[o.what]()

if __name__ == '__main__': main()
