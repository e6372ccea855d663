# SPDX-License-Identifier: BSD-3-Clause
"""The argument itself: one static decomposition, slices, and separate bisections, side by side."""
import re

import figure3
import table1
from common import balance, copies, one, plan, seconds, simulate, table, told

names = ("static", "slices", "own", "auto")


def counted(rows, ranks):
    rows = [r for r in rows if r["machine"] == "cluster"]
    body = []
    for p in ranks:
        for d in names:
            sought, touched = one(rows, "contact: search", p, d), one(rows, "contact: touch", p, d)
            solved = one(rows, "contact: push-back", p, d)
            moved = sum(r["bytes"] for r in rows if r["ranks"] == p and r["decomposition"] == d and r["group"] == "contact")
            particles = [r for r in rows if r["ranks"] == p and r["decomposition"] == d and r["group"] == "particles" and r["phase"].endswith(": forces")]
            body.append((p, d, f"{balance(sought):.2f}", f"{copies(sought, p):.2f}", f"{balance(touched):.2f}", f"{balance(solved):.2f}",
                         f"{balance(particles[0]):.2f}" if particles else "", f"{moved / 1e3:.1f}", f"{1e3 * seconds(rows, 'cluster', p, d, groups={'contact'}):.3f}",
                         f"{1e3 * seconds(rows, 'cluster', p, d):.3f}"))
    head = ["ranks", "decomposition", "search max/mean", "boxes with copies / boxes", "looks at pairs max/mean", "push-back max/mean", "particles max/mean",
            "contact, kB of the busiest rank", "contact, ms", "step, ms"]
    return table(head, body)


def run_so(scene, values, ranks):
    """Real runs: what contact counted, and the bytes that it sent."""
    body = []
    for d in names:
        summary, _, _ = simulate(scene, f"decompositions-{scene}-{d}", {**values, "contact.decomposition": d}, ranks)
        steps = summary["steps"]
        sent = sum(e["bytes"] for e in summary["exchanges"] if e["exchange"].startswith("contact")) / steps
        messages = sum(e["messages"] for e in summary["exchanges"] if e["exchange"].startswith("contact")) / steps
        report = " ".join(line for i in summary["interactions"] for line in i["report"])
        found = re.search(r"of the ranks: search ([\d.]+), enforcement ([\d.]+)", report)
        body.append((d, found[1] if found else "", found[2] if found else "", f"{messages:.1f}", f"{sent / 1e3:.1f}"))
    return table(["decomposition", "search max/mean", "push-back max/mean", "messages a step", "kB a step"], body)


def judge(rows, ranks):
    """Whether separate bisections are the fastest of the three, and where not."""
    lines = []
    for what, groups in (("contact", {"contact"}), ("the step", None)):
        ahead = {p: min(names[:2], key=lambda d: seconds(rows, "cluster", p, d, groups=groups)) for p in ranks}
        gain = {p: seconds(rows, "cluster", p, ahead[p], groups=groups) / seconds(rows, "cluster", p, "auto", groups=groups) for p in ranks}
        lines.append(f"{what} " + ", ".join(f"{gain[p]:.2f} on {p}" for p in ranks))
    touched = {p: (balance(one(rows, "contact: touch", p, "static")), balance(one(rows, "contact: touch", p, "own"))) for p in ranks}
    return (f"\nThe faster of static and slices over `auto`, by predicted time (above 1: `auto` is faster): {'; '.join(lines)}. Looks at pairs of the busiest rank over the "
            "mean, static and separate: " + ", ".join(f"{a:.1f} and {b:.1f} on {p}" for p, (a, b) in touched.items()) + ".\n")


def measure(full):
    text = "## One static decomposition, slices, separate bisections\n\n"
    text += "`static`: search and push-back where the elements are, particles where they were at first. `slices`: slabs across the longest axis. `own`: a bisection for each. `auto` (the default): likewise, but contact is enforced by fewer ranks where each would have too little work to pay for its messages. "
    text += "Predicted for machine cluster from decompositions for each number of ranks.\n"
    ranks = figure3.compared_ranks(full)
    can = figure3.measured_at(figure3.largest(full), ranks)[1]
    text += f"\n`can-crush` with {figure3.largest(full)} doublings after {figure3.during}:\n\n" + counted(can, ranks) + judge(can, ranks)
    bird = plan("bird-strike", "decompositions-bird-strike", {}, ranks, ("cluster",), names, until="0.15 ms", trial=40)[1]
    text += "\n`bird-strike` at 0.15 ms:\n\n" + counted(bird, ranks) + judge(bird, ranks)
    penetrator = table1.predictions(full)[1]
    text += f"\n`penetrator`{told(table1.values_of(full))} at {table1.until}:\n\n" + counted(penetrator, (64, 256, 1024))
    text += judge(penetrator, (64, 256, 1024))
    text += "\n`can-crush` to 0.03 ms on 8 ranks, as run (contact.decomposition); the answer is the same:\n\n"
    return text + run_so("can-crush", {"end_time": "0.03 ms"}, 8)
