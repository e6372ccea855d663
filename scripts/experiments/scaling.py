# SPDX-License-Identifier: BSD-3-Clause
"""The scaling model against measured steps on one and two ranks."""
from common import plan, seconds, table, verdict


def measure(full):
    cases = [("can-crush", {"parameters.doublings": 5 if full else 4}, "0.02 ms"), ("bird-strike", {}, "0.05 ms"), ("taylor-bar-copper", {}, "2 us")]
    body, worst = [], 0.0
    for scene, values, until in cases:
        one, rows, _ = plan(scene, f"scaling-{scene}", values, (1, 2), until=until, trial=40)
        two, _, _ = plan(scene, f"scaling-{scene}-two", values, until=until, trial=40, on=2)
        for ranks, measured in ((1, one), (2, two)):
            predicted = seconds(rows, "here", ranks)
            worst = max(worst, abs(predicted / measured.processor - 1))
            body.append((scene, ranks, f"{1e3 * predicted:.3f}", f"{1e3 * measured.processor:.3f}", f"{100 * (predicted / measured.processor - 1):+.0f} %"))
    text = "## The model against measured steps\n\n"
    text += f"Bar: within 20 % on one and two ranks; the worst here: {100 * worst:.0f} %: {verdict(worst <= 0.2)}.\n\n"
    text += "Processor time of the busier rank. One rank is what the model was measured with. Where ranks wait much for each other, as with many small messages on a machine that others use, they poll: that is in the measured time, and not in the model.\n\n"
    return text + table(["scene", "ranks", "predicted, ms", "measured, ms", "error"], body)
