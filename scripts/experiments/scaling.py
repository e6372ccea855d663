# SPDX-License-Identifier: BSD-3-Clause
"""The scaling model against measured steps on one and two ranks."""
from common import plan, seconds, table


def measure(full):
    cases = [("can-crush", {"parameters.doublings": 5 if full else 4}, "0.02 ms"), ("tube-crush", {}, "0.02 ms"), ("bird-strike", {"meshes.bird.spacing": "2 mm"}, "0.1 ms"),
             ("taylor-bar-copper", {}, "2 us")]
    body = []
    for scene, values, until in cases:
        one, rows, _ = plan(scene, f"scaling-{scene}", values, (1, 2), until=until, trial=40)
        two, _, _ = plan(scene, f"scaling-{scene}-two", values, until=until, trial=40, on=2)
        for ranks, measured in ((1, one), (2, two)):
            predicted = seconds(rows, "here", ranks)
            body.append((scene, ranks, f"{1e3 * predicted:.3f}", f"{1e3 * measured.processor:.3f}", f"{100 * (predicted / measured.processor - 1):+.0f} %",
                         f"{1e3 * measured.clock:.3f}"))
    text = "## The model against measured steps\n\n"
    text += "Bar: within 20 % on one and two ranks. Processor time of the busier rank; by the clock, too, which on a machine that others use says little.\n\n"
    return text + table(["scene", "ranks", "predicted, ms", "measured, ms", "error", "by the clock, ms"], body)
