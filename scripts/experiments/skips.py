# SPDX-License-Identifier: BSD-3-Clause
"""What the skips save: runs with and without them, and whether their states are the same bits."""
import hashlib
import subprocess

from common import simulate, table, verdict

# Scene, short end, and the switch that does everything in each step.
cases = [("can-crush", {"end_time": "0.05 ms"}, {"contact.always_search": "true"}),
         ("tube-crush", {"end_time": "0.02 ms"}, {"contact.always_search": "true"}),
         ("bird-strike", {"end_time": "0.05 ms"}, {"contact.always_search": "true", "components.bird.always_search": "true"}),
         ("hot-taylor-bar", {"end_time": "5 us"}, {})]


def same(a, b):
    done = subprocess.run(["h5diff", a / "final.h5", b / "final.h5"], capture_output=True, text=True)
    return done.returncode == 0 and not done.stdout.strip()


def digest(folder):
    return hashlib.sha256((folder / "history.csv").read_bytes()).hexdigest()[:12]


def measure(full):
    body, said, identical = [], [], True
    for scene, values, switch in cases:
        summary, seconds, folder = simulate(scene, f"skips-{scene}", values)
        said += [(scene, f"{row['component']}: {row['what']}", row["times"], summary["steps"]) for row in summary["skipped"] if row["times"] > 0]
        if not switch:
            continue
        _, without, other = simulate(scene, f"skips-{scene}-off", {**values, **switch})
        identical = identical and same(folder, other) and digest(folder) == digest(other)
        body.append((scene, ", ".join(switch), f"{without:.1f}", f"{seconds:.1f}", f"{without / seconds:.2f}", "yes" if same(folder, other) else "NO",
                     digest(folder) + (" = " if digest(folder) == digest(other) else " != ") + digest(other)))
    text = "## What is skipped\n\nUser seconds of whole runs on one rank, with the switch that does everything in every step and without; the final states are compared bit by bit.\n\n"
    text += f"Bar: the same bits with every skip and without: {verdict(identical)}.\n\n"
    text += table(["scene", "switch", "never skipping, s", "skipping, s", "ratio", "same bits", "SHA-256 of history.csv"], body)
    return text + "\nWhat the runs say they left out:\n\n" + table(["scene", "what", "times", "steps"], said)
