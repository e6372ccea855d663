# SPDX-License-Identifier: BSD-3-Clause
"""What all experiments share: running Tenon, reading its tables, and the sections of docs/experiments.md."""
import csv
import json
import os
import re
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

root = Path(__file__).resolve().parents[2]
scenes = root / "apps" / "scenes"
out = root / "out" / "experiments"
document = root / "docs" / "experiments.md"
order = ["figure3", "table1", "decompositions", "skips", "scaling"]
tenon = plot = None
clock = None  # a library to be preloaded, which makes timers count processor time
reuse = False  # what an earlier call has measured
environment = dict(os.environ)

heading = """# Experiments

What the paper measured, measured again: `scripts/reproduce [figure3|table1|decompositions|skips|scaling|all] [--full]` makes each section from runs and from
`tenon plan --ranks`. A predicted step is the sum over its phases of the slowest rank's work, messages (each its latency, and its bytes over the bandwidth, nothing
overlapped) and reductions (one latency for each doubling of the ranks). Work, copies, messages and bytes are counted from decompositions for that many ranks, made in one
process by the code that a run uses; what a unit of work costs is measured by steps of the same scene on one core.

| machine | latency | bandwidth of a rank | work |
| --- | --- | --- | --- |
| here | 1 us (assumed, shared memory) | 5 GB/s (assumed) | as measured |
| tflops: Sandia/Intel TFLOPS, 1997 | 20 us (assumed) | 310 MB/s (assumed) | 100 times as slow (146 MFLOPS of LINPACK a processor: 1.338 TFLOPS on 9,152) |
| cluster: today | 1.5 us (assumed) | 10 GB/s (assumed) | as measured here |
"""


def prepare(build, keep, processor_time):
    """Finds the programs and lets Open MPI run as the other scripts do."""
    global tenon, plot, reuse, clock
    reuse = keep
    folder = (root / build).resolve()
    tenon, plot = folder / "tenon", folder / "tenon_plot_table"
    if not tenon.exists():
        raise SystemExit(f"{tenon}: is not there; build it first: scripts/setup tenon tenon_plot_table")
    out.mkdir(parents=True, exist_ok=True)
    if processor_time:
        clock = out / "processor_clock.so"
        subprocess.run(["cc", "-O2", "-shared", "-fPIC", str(root / "scripts" / "experiments" / "processor_clock.c"), "-o", str(clock)], check=True)
    for line in (root / "scripts" / "mpi-environment").read_text().splitlines():
        if line.startswith("export "):
            environment.update(word.split("=", 1) for word in line[len("export "):].split() if "=" in word)


def run(arguments, ranks=1, log=None):
    """Runs a program and returns what it prints; with mpirun on more ranks."""
    command = [str(a) for a in arguments]
    if ranks > 1:
        command = ["mpirun", "--oversubscribe", "-n", str(ranks), *(["-x", f"LD_PRELOAD={clock}"] if clock else []), *command]
    print("  " + " ".join(command).replace(str(root) + "/", ""), flush=True)
    asked = "# " + " ".join(command) + "\n"
    if reuse and log and (out / log).exists() and (out / log).read_text().startswith(asked):
        return (out / log).read_text()[len(asked):]
    done = subprocess.run(command, env={**environment, "LD_PRELOAD": str(clock)} if clock and ranks == 1 and command[0] == str(tenon) else environment, cwd=out, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if log:
        (out / log).write_text((asked if done.returncode == 0 else "") + done.stdout)
    if done.returncode:
        raise SystemExit(done.stdout[-3000:] + f"\nfailed: {' '.join(command)}")
    return done.stdout


def told(values):
    """Settings as a reader would type them; nothing if there are none."""
    return "".join(f" `--set {key}={value}`" for key, value in values.items())


def settings(values):
    return [word for key, value in values.items() for word in ("--set", f"{key}={value}")]


@dataclass
class Trial:
    """What `tenon plan` measured, per step."""
    steps: int
    clock: float
    processor: float
    phases: dict = field(default_factory=dict)
    counts: dict = field(default_factory=dict)


def read_trial(text):
    match = re.search(r"measured per step of (\d+) on \d+ ranks: (\S+) s by the clock, (\S+) s of the processor", text)
    trial = Trial(int(match[1]), float(match[2]), float(match[3]))
    for name, seconds in re.findall(r"^  (\S.*?) +(\d\.\d+e[+-]\d+) s$", text, re.M):
        trial.phases[name] = float(seconds)
    for name, count in re.findall(r"^  (\S.*?) +(\d+\.\d{4})$", text, re.M):
        trial.counts[name] = float(count)
    return trial


def plan(scene, name, values, ranks=(), machines=("here",), decompositions=("auto",), until=None, during=None, trial=20, on=1):
    """`tenon plan` of a scene, measured for some steps after `until`, or from the start to the time `during`: what was measured, and the rows of the prediction."""
    table = out / f"{name}.csv"
    command = [tenon, "plan", scenes / scene / "scene.yaml", *settings(values)]
    if during:
        command += ["--measure-until", during]
    else:
        command += ["--trial", trial]
    if until:
        command += ["--until", until]
    if ranks:
        command += ["--ranks", ",".join(map(str, ranks)), "--machine", ",".join(machines), "--decomposition", ",".join(decompositions), "--csv", table]
    text = run(command, on, f"{name}.txt")
    rows = []
    if ranks:
        with open(table) as file:
            for row in csv.DictReader(file):
                rows.append({k: v if k in ("machine", "decomposition", "group", "phase") else float(v) for k, v in row.items()})
    return read_trial(text), rows, text


def seconds(rows, machine, ranks, decomposition="auto", groups=None, phases=None):
    """Predicted seconds of a step, of some groups or of phases that end with one of these words."""
    return sum(r["seconds"] for r in rows if r["machine"] == machine and r["ranks"] == ranks and r["decomposition"] == decomposition
               and (groups is None or r["group"] in groups) and (phases is None or r["phase"].endswith(phases)))


def one(rows, phase, ranks, decomposition="auto", machine=None):
    """The row of a phase."""
    for r in rows:
        if r["phase"].endswith(phase) and r["ranks"] == ranks and r["decomposition"] == decomposition and machine in (None, r["machine"]):
            return r
    raise KeyError(phase)


def verdict(met):
    return "met" if met else "**missed**"


def balance(row):
    return row["work_max"] / row["work_mean"] if row["work_mean"] else 1.0


def copies(row, ranks):
    """How often an item is worked on."""
    return row["work_mean"] * ranks / row["work_whole"] if row["work_whole"] else 1.0


def simulate(scene, name, values, ranks=1):
    """`tenon run` without frames: its summary, and the user seconds of all ranks."""
    folder = out / name
    before = os.times()
    run([tenon, "run", scenes / scene / "scene.yaml", "-o", folder, *settings(values)], ranks, f"{name}.txt")
    user = os.times().children_user - before.children_user
    taken = out / f"{name}.seconds"
    if user < 0.01 and taken.exists():  # kept from an earlier call
        user = float(taken.read_text())
    taken.write_text(str(user))
    return json.loads((folder / "summary.json").read_text()), user, folder


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "| " + " | ".join("---" for _ in head) + " |"]
    return "\n".join(lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]) + "\n"


def draw(name, rows, width=1600, height=600):
    """A picture of (panel, x_title, y_title, line, x, y, guide) rows; returns its place in the document."""
    path = out / f"{name}-plot.csv"
    with open(path, "w") as file:
        writer = csv.writer(file)
        writer.writerow(["panel", "x_title", "y_title", "line", "x", "y", "guide"])
        writer.writerows(rows)
    picture = root / "docs" / "images" / f"experiments-{name}.png"
    picture.parent.mkdir(exist_ok=True)
    run([plot, path, picture, width, height])
    return f"![{name}](images/{picture.name})\n"


def machine():
    """Cores, CPU and compiler in a line."""
    cpu = re.search(r"model name\s*: (.*)", Path("/proc/cpuinfo").read_text())
    version = " ".join(subprocess.run([tenon, "--version"], text=True, capture_output=True, env=environment).stdout.split("\n")).strip()
    load = os.getloadavg()[0]
    kind = "in processor time, as others used the machine (--processor-time), " if clock else ""
    return f"Measured {kind}on {os.cpu_count()} cores of {cpu[1] if cpu else 'an unknown processor'}, load {load:.1f}; {version}."


def write_section(name, text):
    """Replaces the section of an experiment in the document."""
    sections = {}
    if document.exists():
        sections = dict(re.findall(r"<!-- (\w+) -->\n(.*?)<!-- end -->\n", document.read_text(), re.S))
    sections[name] = text.rstrip() + "\n\n" + machine() + "\n"
    body = "\n".join(f"<!-- {key} -->\n{sections[key]}<!-- end -->\n" for key in order if key in sections)
    document.write_text(heading + "\n" + body)
