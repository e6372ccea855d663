# SPDX-License-Identifier: BSD-3-Clause
"""Table 1: the penetrator; seconds a step on 64 to 1,024 ranks predicted, on one and two ranks measured."""
import functools
import re

from common import balance, copies, draw, plan, seconds, table, told, verdict

paper = {64: (0.409, 4.55, 1.24, 6.27), 128: (0.191, 2.36, 0.715, 3.30), 256: (0.102, 1.30, 0.533, 1.97), 512: (0.0525, 0.708, 0.334, 1.11),
         1024: (0.0303, 0.423, 0.238, 0.704)}
ranks = (64, 128, 256, 512, 1024)
groups = (("elements", {"finite elements"}), ("particles", {"particles"}), ("contact", {"contact"}))
paper_elements, paper_particles = 155000, 415000


until, trial = "10 us", 40
machines = ("tflops", "cluster", "here")


def values_of(full):
    """The resolution with the least greater error of the two numbers of the paper."""
    return {"parameters.resolution": 4.2} if full else {}


@functools.cache
def predictions(full):
    return plan("penetrator", "table1", values_of(full), (1, 2, *ranks), machines, ("auto", "own", "static", "slices"), until=until, trial=trial)


def sizes(text):
    """Elements and particles, from the lines of the meshes."""
    meshes = re.findall(r"^mesh (\w+): \d+ nodes, (\d+) elements .*$", text, re.M)
    return sum(int(n) for name, n in meshes if name != "target"), sum(int(n) for name, n in meshes if name == "target")


def where_the_time_goes(rows, machine):
    body = []
    for p in (ranks[0], ranks[-1]):
        for r in rows:
            if r["machine"] != machine or r["ranks"] != p or r["decomposition"] != "auto" or r["seconds"] < 1e-3 * seconds(rows, machine, p):
                continue
            body.append((p, r["phase"], f"{balance(r):.2f}", f"{copies(r, p):.2f}", f"{r['messages']:.1f}", f"{r['reductions']:.1f}", f"{r['bytes'] / 1e3:.1f}",
                         f"{1e3 * r['computing_s']:.2f}", f"{1e3 * r['seconds']:.2f}"))
    text = f"Where the time goes (machine {machine}; copies are items with ghosts over items; messages, reductions and kB of the busiest rank; phases above a thousandth of the step):\n\n"
    return text + table(["ranks", "phase", "max/mean", "copies", "messages", "reductions", "kB", "computing, ms", "all, ms"], body) + "\n"


def measure(full):
    values = values_of(full)
    measured, rows, text_of_plan = predictions(full)
    smaller = {"parameters.resolution": 2 if full else 1.5}
    one, small_rows, _ = plan("penetrator", "table1-one", smaller, (1, 2), ("here",), until=until, trial=trial)
    two, _, _ = plan("penetrator", "table1-two", smaller, until=until, trial=trial, on=2)
    elements, particles = sizes(text_of_plan)
    text = "## Table 1: a penetrator in a target of particles\n\n"
    text += f"`apps/scenes/penetrator`{told(values)}: {elements} elements ({100 * (elements / paper_elements - 1):+.1f} % of the paper's {paper_elements}), "
    text += f"{particles} particles ({100 * (particles / paper_particles - 1):+.1f} % of {paper_particles}). Predicted from {measured.steps} steps at {until} of its run, measured on one core, "
    text += f"with {measured.counts.get('contact: searches', 0) * measured.steps:.0f} searches of contact and {measured.counts.get('contact: iterations', 0):.1f} iterations of it a step among them.\n\n"
    best = {m: seconds(rows, m, ranks[0]) / seconds(rows, m, ranks[-1]) for m in machines}
    bar = paper[64][3] / paper[1024][3]
    text += f"Bar: a speed-up from 64 to 1024 ranks above the paper's {bar:.2f} on its machine; predicted {best['tflops']:.2f}: {verdict(best['tflops'] > bar)}"
    text += "" if full else " (at this smaller size, where it says little)"
    text += f". On machine cluster, where work costs a hundredth and a message a thirteenth, {best['cluster']:.2f}.\n"
    halves = one.processor / two.processor
    text += f"Bar: 1.8 from one rank to two, measured (processor time of the busier rank, waiting included): {halves:.2f}: {verdict(halves >= 1.8)}.\n\n"
    lines = []
    for m in machines[:2]:
        body, first = [], None
        for p in ranks:
            parts = [seconds(rows, m, p, groups=g) for _, g in groups] + [seconds(rows, m, p)]
            first = first or parts
            body.append((p, *(f"{x:.3e} ({f / x:.2f})" for x, f in zip(parts, first)), " / ".join(f"{paper[64][k] / paper[p][k]:.2f}" for k in range(4))))
            for (name, _), x, f in zip((*groups, ("all", None)), parts, first):
                lines.append((f"speed-up over 64 ranks: {m}", "ranks", "speed-up", name, p, f / x, 0))
            lines.append((f"speed-up over 64 ranks: {m}", "ranks", "speed-up", "PRONTO 1997", p, paper[64][3] / paper[p][3], 1))
        text += f"Predicted, machine {m}: seconds per step (speed-up over 64 ranks).\n\n"
        text += table(["ranks", *(name for name, _ in groups), "all", "paper: elements / particles / contact / all"], body) + "\n"
    text += where_the_time_goes(rows, "tflops")
    text += f"Measured per step on one and two ranks with{told(smaller)}, ms (the mean of the ranks; waiting is in it):\n\n"
    kinds = (("elements", ("penetrator: ", "ring: ", "support: ")), ("particles", ("target: ",)), ("contact", ("contact: ",)))
    body = []
    for name, starts in kinds:
        a, b = (sum(x for phase, x in trial.phases.items() if phase.startswith(starts)) for trial in (one, two))
        p, q = (seconds(small_rows, "here", k, groups=dict(groups)[name]) for k in (1, 2))
        body.append((name, f"{1e3 * a:.3f}", f"{1e3 * b:.3f}", f"{a / b:.2f}", f"{p / q:.2f}"))
    p, q = (seconds(small_rows, "here", k) for k in (1, 2))
    body.append(("all", f"{1e3 * one.processor:.3f}", f"{1e3 * two.processor:.3f}", f"{halves:.2f}", f"{p / q:.2f}"))
    text += table(["phase", "1 rank", "2 ranks", "speed-up", "predicted"], body) + "\n"
    return text + draw("table1", lines, 1600, 560)
