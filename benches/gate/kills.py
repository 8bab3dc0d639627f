#!/usr/bin/env python3
"""Kills the program at random moments and looks at what it leaves behind.

  benches/gate/kills.py target/release/moduli [--kills 50]

For `grasp`, `library build` and a transfer matrix, each in a folder of its own: the command is started and
killed (SIGKILL) after a random part of its time, so many times. After every kill each file in the folder
is one of the expected results and is whole. At the end the command runs through, and its results have the
bytes of a run that was never interrupted. Prints a line per command; exits with 1 on the first fault.
"""
import argparse, hashlib, json, math, os, random, shutil, signal, subprocess, sys, tempfile, time

def ellipsoid(path, axes, count=1500):
    with open(path, 'w') as f:
        for k in range(count):
            z = 1 - (2 * k + 1) / count; phi = k * math.pi * (3 - math.sqrt(5)); s = math.sqrt(1 - z * z)
            f.write(f'{axes[0] * s * math.cos(phi)} {axes[1] * s * math.sin(phi)} {axes[2] * z}\n')

def files(folder):
    return sorted(os.path.relpath(os.path.join(d, f), folder) for d, _, names in os.walk(folder) for f in names)

def digest(folder):
    return {f: hashlib.sha256(open(os.path.join(folder, f), 'rb').read()).hexdigest() for f in files(folder)}

def whole(program, path):
    """Whether a result is complete: JSON parses, a page ends, a record has its length and checksum."""
    data = open(path, 'rb').read()
    if path.endswith('.json'): json.loads(data)
    elif path.endswith('.html'): assert data.rstrip().endswith(b'</html>')
    elif path.endswith('.object'): assert subprocess.run([program, 'info', path], capture_output=True).returncode == 0
    elif path.endswith('.yaml'): assert data.endswith(b'\n') and b'grasps' in data
    elif path.endswith('.jsonl'): pass  # a ledger is read line by line; its last line may be cut off
    else: raise AssertionError('a file that is no result')

def check(program, folder, expected):
    for name in files(folder):
        if name not in expected: raise SystemExit(f'left over: {folder}/{name}')
        try: whole(program, os.path.join(folder, name))
        except Exception as e: raise SystemExit(f'not whole: {folder}/{name}: {e!r}')

def attack(program, name, words, work, kills, rng):
    """`words` holds OUT where the folder of results goes."""
    def start(out): return subprocess.Popen([program, *[out if w == 'OUT' else w for w in words], '-q'], cwd=work, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    out = os.path.join(work, name)  # one name for all runs: results name their files
    begun = time.time()
    if start(out).wait() != 0: raise SystemExit(f'{name}: the command fails')
    seconds = time.time() - begun; expected = digest(out); shutil.rmtree(out)
    died = lost = 0; before = set()
    while died < kills:
        process = start(out); time.sleep(rng.uniform(0, seconds)); process.send_signal(signal.SIGKILL)
        killed = process.wait() == -signal.SIGKILL; died += killed
        if not os.path.isdir(out): continue
        check(program, out, expected)
        now = set(files(out)); lost += len(before - now); before = now
        if not killed:  # it had ended before: begin again
            if digest(out) != expected: raise SystemExit(f'{name}: other bytes than without interruption')
            shutil.rmtree(out); before = set()
    if lost: raise SystemExit(f'{name}: {lost} finished results were lost')
    if start(out).wait() != 0: raise SystemExit(f'{name}: the command fails after it was killed')
    if digest(out) != expected: raise SystemExit(f'{name}: other bytes than without interruption')
    print(f'{name}: killed {died} times, {len(expected)} results whole and the same, {seconds:.1f} s per run', flush=True)

def main():
    a = argparse.ArgumentParser(); a.add_argument('program'); a.add_argument('--kills', type=int, default=50); a.add_argument('--seed', type=int, default=1)
    o = a.parse_args(); program = os.path.abspath(o.program); rng = random.Random(o.seed)
    work = tempfile.mkdtemp()
    try:
        shapes = []
        for k, axes in enumerate([(.03, .03, .045), (.04, .035, .022), (.03, .04, .05), (.028, .028, .06)]):
            ellipsoid(os.path.join(work, f'e{k}.xyz'), axes)
            subprocess.run([program, 'fit', f'e{k}.xyz', '--degree', '10', '-q', '-o', f'e{k}.shape'], cwd=work, check=True, stdout=subprocess.DEVNULL)
            subprocess.run([program, 'synthesize', f'e{k}.shape', '--poses', '60', '-q', '-o', f's{k}'], cwd=work, check=True, stdout=subprocess.DEVNULL)
            shapes.append(f'e{k}.shape')
        clouds = [f'e{k}.xyz' for k in range(4)]
        attack(program, 'grasp', ['grasp', *clouds[:2], '--poses', '200', '-o', 'OUT'], work, o.kills, rng)
        attack(program, 'library', ['library', 'build', 'OUT', *clouds, '--degree', '10', '--poses', '300'], work, o.kills, rng)
        pairs = [w for k in range(4) for w in ('--from', f'e{k}.shape')] + [w for k in range(4) for w in ('--to', f'e{k}.shape')]
        attack(program, 'transfer', ['transfer', *pairs, *[f's{k}/grasps.json' for k in range(4)], '-o', 'OUT'], work, o.kills, rng)
    finally: shutil.rmtree(work)

if __name__ == '__main__': main()
