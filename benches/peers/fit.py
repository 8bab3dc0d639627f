#!/usr/bin/env python3
"""Plain least squares (λ = 0) side by side with ducc0's LSMR on a non-uniform FFT, in one run.

  pip install numpy ducc0
  benches/peers/fit.py objects FOLDER [--degree 50 --runs 5]   the `main` objects of FOLDER/index.tsv
  benches/peers/fit.py large [--degree 200 --count 1000000]    made-up points, uniform on the sphere

Both sides get the same centred points and two threads and run one after the other; ours is the
example `fit_clouds` of the crate moduli-sph. Times are medians and exclude reading files.
"""
import argparse, json, os, subprocess, tempfile, time
import numpy as np
import ducc0

def say(**k): print(json.dumps(k), flush=True)

def load(path):
    with open(path, 'rb') as f:
        n = 0
        while (line := f.readline().decode('ascii').strip()) != 'end_header':
            if line.startswith('element vertex'): n = int(line.split()[-1])
        p = np.frombuffer(f.read(12 * n), '<f4').reshape(n, 3).astype(float)
    return p - p.mean(0)

def median(run, runs):
    t = []
    for _ in range(runs):
        a = time.perf_counter(); v = run(); t.append(time.perf_counter() - a)
    return float(np.median(t)), v

def peer(p, degree, runs):
    r = np.linalg.norm(p, axis=1); d = p / r[:, None]
    loc = np.stack([np.arccos(np.clip(d[:, 2], -1, 1)), np.mod(np.arctan2(d[:, 1], d[:, 0]), 2 * np.pi)], 1)
    s, v = median(lambda: ducc0.sht.pseudo_analysis_general(lmax=degree, map=r[None], loc=loc, spin=0, nthreads=2, maxiter=5000, epsilon=1e-10), runs)
    h = ducc0.sht.synthesis_general(lmax=degree, alm=v[0], loc=loc, spin=0, epsilon=1e-12, nthreads=2)[0]
    return s, int(v[2]), float(np.sqrt(np.mean((h - r) ** 2)))

def ours(p, degree, runs, mode='plain'):
    with tempfile.NamedTemporaryFile() as f:
        p.astype('<f8').tofile(f.name)
        command = f'cargo run -q --release -p moduli-sph --example fit_clouds -- {degree} {mode} {runs} {f.name}'
        out = subprocess.run(command.split(), capture_output=True, text=True, env=dict(os.environ, RAYON_NUM_THREADS='2'))
        if out.returncode: raise SystemExit(out.stderr)
    _, s, rms, *_ = out.stdout.split()
    return float(s), float(rms)

def compare(name, p, degree, runs):
    s, iterations, rms = peer(p, degree, runs); t, our_rms = ours(p, degree, runs)
    say(case=name, points=len(p), degree=degree, ducc0_s=round(s, 4), iterations=iterations, ours_s=t, ratio=round(s / t, 1), ducc0_rms=rms, ours_rms=our_rms)
    return s / t

def objects(folder, degree, runs):
    rows = [line.split('\t') for line in open(os.path.join(folder, 'index.tsv')).read().splitlines()[1:]]
    ratios = [compare(r[0], load(os.path.join(folder, r[2])), degree, runs) for r in rows if r[1] == 'main']
    say(case='all', objects=len(ratios), geometric_mean=round(float(np.exp(np.mean(np.log(ratios)))), 1), least=round(min(ratios), 1))

def large(count, degree, runs):
    rng = np.random.default_rng(1); p = rng.normal(size=(count, 3)); p /= np.linalg.norm(p, axis=1)[:, None]
    p *= (0.05 + 0.01 * np.sin(3 * p[:, 0]) * p[:, 1] + 1e-4 * rng.normal(size=count))[:, None]
    compare('large', p, degree, runs)

def main():
    a = argparse.ArgumentParser(); a.add_argument('what', choices=['objects', 'large']); a.add_argument('folder', nargs='?', default='.')
    a.add_argument('--degree', type=int); a.add_argument('--count', type=int, default=1000000); a.add_argument('--runs', type=int, default=3)
    o = a.parse_args()
    if o.what == 'objects': objects(o.folder, o.degree or 50, o.runs)
    else: large(o.count, o.degree or 200, o.runs)

if __name__ == '__main__': main()
