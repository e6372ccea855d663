# SPDX-License-Identifier: BSD-3-Clause
"""Figure 3: a can crushed at doublings of its mesh; seconds a step over size and over ranks with constant elements a rank."""
import math
import re

from common import balance, copies, draw, one, plan, seconds, table

elements_per_rank = 1875
paper_ranks = 3504
finite_elements = {"finite elements"}
search = ("contact: check", "contact: search", "contact: share out")
push_back = ("contact: touch", "contact: solve", "contact: exchange")


def parts_of(rows, machine, ranks):
    return (seconds(rows, machine, ranks, groups=finite_elements), seconds(rows, machine, ranks, phases=search),
            seconds(rows, machine, ranks, phases=push_back), seconds(rows, machine, ranks))


def beyond(rows, machine, ranks, target):
    """Constant work, messages and bytes a rank: only reductions take longer."""
    total = list(parts_of(rows, machine, ranks))
    latency = {"here": 1e-6, "tflops": 20e-6, "cluster": 1.5e-6}[machine]
    more = math.ceil(math.log2(target)) - math.ceil(math.log2(ranks))
    for r in rows:
        if r["machine"] != machine or r["ranks"] != ranks:
            continue
        extra = r["reductions"] * latency * more
        place = 0 if r["group"] in finite_elements else 1 if r["phase"].endswith(search) else 2 if r["phase"].endswith(push_back) else 3
        if place < 3:
            total[place] += extra
        total[3] += extra
    return tuple(total)


def measure(full):
    sizes = range(9) if full else range(5)
    until = "0.02 ms"
    machines = ("here", "tflops", "cluster")
    measured, weak, lines, last = [], [], [], None
    for doublings in sizes:
        ranks = 2**doublings
        _, rows, text = plan("can-crush", f"figure3-{doublings}", {"parameters.doublings": doublings}, sorted({1, ranks}), machines, until=until,
                             trial=100 if doublings < 5 else 20)
        elements = sum(int(n) for n in re.findall(r"^  (\d+) elements, \d+ nodes in 1 parts", text, re.M))
        fe, find, push, total = parts_of(rows, "here", 1)
        measured.append((elements, fe, find, push, total))
        for name, value in (("elements", fe), ("+ search", fe + find), ("+ push-back", fe + find + push), ("all", total)):
            lines.append(("one core", "elements", "microseconds per element and step", name, elements, 1e6 * value / elements, 0))
        weak.append((ranks, rows))
        last = (ranks, rows)
    each = [m[4] / m[0] for m in measured]
    spread = max(each) / min(each) - 1
    text = "## Figure 3: an inclined wall crushes a can\n\n"
    text += (f"`apps/scenes/can-crush` at {until} of its run, doubled {len(measured) - 1} times, on one core. Search is contact's check, search and sharing out; push-back its "
             f"touches, iterations and exchange. Bar: the time of an element-step is flat within 15 %; found: {100 * spread:.0f} % between the least and the greatest.\n\n")
    text += table(["elements", "elements, ms", "search, ms", "push-back, ms", "all, ms", "us per element-step"],
                  [(n, *(f"{1e3 * x:.3f}" for x in (fe, find, push, total)), f"{1e6 * total / n:.3f}") for n, fe, find, push, total in measured])
    text += f"\nPredicted with {elements_per_rank} elements a rank, each row from a mesh of that size decomposed for its ranks; ms per step.\n\n"
    rows_of_table = []
    for ranks, rows in weak:
        rows_of_table.append((ranks, *(f"{1e3 * x:.3f}" for m in machines[1:] for x in parts_of(rows, m, ranks)),
                              f"{balance(one(rows, 'contact: search', ranks)):.2f}", f"{balance(one(rows, 'contact: touch', ranks)):.2f}",
                              f"{balance(one(rows, 'contact: solve', ranks)):.2f}", f"{copies(one(rows, ': forces', ranks), ranks):.2f}"))
        for m in machines[1:]:
            fe, find, push, total = parts_of(rows, m, ranks)
            for name, value in (("elements", fe), ("+ search", fe + find), ("+ push-back", fe + find + push), ("all", total)):
                lines.append((f"constant size a rank: {m}", "ranks", "milliseconds per step", name, ranks, 1e3 * value, 0))
    ranks, rows = last
    rows_of_table.append((f"{paper_ranks} (extrapolated)", *(f"{1e3 * x:.3f}" for m in machines[1:] for x in beyond(rows, m, ranks, paper_ranks)), "", "", "", ""))
    for m in machines[1:]:
        fe, find, push, total = beyond(rows, m, ranks, paper_ranks)
        for name, value in (("elements", fe), ("+ search", fe + find), ("+ push-back", fe + find + push), ("all", total)):
            lines.append((f"constant size a rank: {m}", "ranks", "milliseconds per step", name, paper_ranks, 1e3 * value, 0))
    head = ["ranks"] + [f"{m}: {x}" for m in machines[1:] for x in ("elements", "search", "push-back", "all")]
    text += table(head + ["search max/mean", "touch max/mean", "push-back max/mean", "elements computed / elements"], rows_of_table)
    text += (f"\nThe row of {paper_ranks} ranks takes the loads of {ranks} ranks and longer reductions; balance and messages still grow up to there, so it is the least that is to be expected.\n\n")
    return text + draw("figure3", lines, 1800, 560)
