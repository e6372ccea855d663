# SPDX-License-Identifier: BSD-3-Clause
"""Table 1: the penetrator; seconds a step on 64 to 1,024 ranks predicted, on one and two ranks measured."""
import functools

from common import draw, plan, seconds, table

paper = {64: (0.409, 4.55, 1.24, 6.27), 128: (0.191, 2.36, 0.715, 3.30), 256: (0.102, 1.30, 0.533, 1.97), 512: (0.0525, 0.708, 0.334, 1.11),
         1024: (0.0303, 0.423, 0.238, 0.704)}
ranks = (64, 128, 256, 512, 1024)
groups = (("elements", {"finite elements"}), ("particles", {"particles"}), ("contact", {"contact"}))


until, trial = "20 us", 20
machines = ("tflops", "cluster", "here")


def values_of(full):
    return {"parameters.resolution": 4.16} if full else {}


@functools.cache
def predictions(full):
    return plan("penetrator", "table1", values_of(full), (1, 2, *ranks), machines, ("own", "static", "slices"), until=until, trial=trial)


def measure(full):
    values = values_of(full)
    _, rows, text_of_plan = predictions(full)
    smaller = {"parameters.resolution": 2 if full else 1.5}
    one, small_rows, _ = plan("penetrator", "table1-one", smaller, (1, 2), ("here",), until=until, trial=trial)
    two, _, _ = plan("penetrator", "table1-two", smaller, until=until, trial=trial, on=2)
    sizes = [line.strip() for line in text_of_plan.splitlines() if " elements, " in line and " parts" in line]
    text = "## Table 1: a penetrator in a target of particles\n\n"
    text += f"`apps/scenes/penetrator`{' ' + str(values) if values else ''}: " + "; ".join(sizes) + ".\n\n"
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
    text += f"Measured per step on one and two ranks at {smaller}, ms (the mean of the ranks; waiting is in it):\n\n"
    kinds = (("elements", ("penetrator: ", "ring: ")), ("particles", ("target: ",)), ("contact", ("contact: ",)))
    body = []
    for name, starts in kinds:
        a, b = (sum(x for phase, x in trial.phases.items() if phase.startswith(starts)) for trial in (one, two))
        p, q = (seconds(small_rows, "here", k, groups=dict(groups)[name]) for k in (1, 2))
        body.append((name, f"{1e3 * a:.3f}", f"{1e3 * b:.3f}", f"{a / b:.2f}", f"{p / q:.2f}"))
    p, q = (seconds(small_rows, "here", k) for k in (1, 2))
    body.append(("all", f"{1e3 * one.processor:.3f}", f"{1e3 * two.processor:.3f}", f"{one.processor / two.processor:.2f}", f"{p / q:.2f}"))
    text += table(["phase", "1 rank", "2 ranks", "speed-up", "predicted"], body) + "\n"
    return text + draw("table1", lines, 1600, 560)
