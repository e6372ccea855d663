# SPDX-License-Identifier: BSD-3-Clause
"""Runs of either program on one core, timed by the processor seconds of the whole process."""
import csv
import json
import os
import resource
import subprocess
import tempfile

REPOSITORY = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", "..", ".."))


def environment():
    """One thread, and MPI as scripts/mpi-environment sets it."""
    text = subprocess.run(["bash", "-c", f". '{REPOSITORY}/scripts/mpi-environment'; env -0"], capture_output=True, check=True)
    values = dict(entry.split("=", 1) for entry in text.stdout.decode().split("\0") if "=" in entry)
    return values | {"OMP_NUM_THREADS": "1", "CCX_NPROC_RESULTS": "1", "NUMBER_OF_CPUS": "1"}


MOST_SECONDS = 600  # of one run; it is ended then


def timed(command, folder):
    """Processor seconds (user and system), and whether it ended well."""
    limit = lambda: resource.setrlimit(resource.RLIMIT_CPU, (MOST_SECONDS, MOST_SECONDS))
    with open(os.path.join(folder, "log"), "w") as log:
        process = subprocess.Popen(command, cwd=folder, stdout=log, stderr=log, env=environment(), preexec_fn=limit)
        _, status, usage = os.wait4(process.pid, 0)
    return usage.ru_utime + usage.ru_stime, status == 0


def best(repeats, command, folder):
    results = [timed(command, folder) for _ in range(repeats)]
    if not all(good for _, good in results):
        raise RuntimeError(f"{' '.join(command)} failed; see {folder}/log")
    return min(seconds for seconds, _ in results)


class Tenon:
    def __init__(self, build):
        self.program = os.path.join(os.path.abspath(build), "tenon")

    def run(self, folder, scene, repeats=1):
        """Seconds, summary and the last row of history.csv of a scene (text)."""
        with open(os.path.join(folder, "scene.yaml"), "w") as file:
            file.write(scene)
        seconds = best(repeats, [self.program, "run", "scene.yaml", "-o", "out"], folder)
        with open(os.path.join(folder, "out", "summary.json")) as file:
            summary = json.load(file)
        with open(os.path.join(folder, "out", "history.csv")) as file:
            row = list(csv.DictReader(file))[-1]
        return seconds, summary, {key: float(value) for key, value in row.items()}


class CalculiX:
    program = "ccx"

    def run(self, folder, deck, repeats=1):
        """Seconds, and the last block of each printed table: {title: {key of the row: values}}."""
        with open(os.path.join(folder, "deck.inp"), "w") as file:
            file.write(deck)
        seconds = best(repeats, [self.program, "deck"], folder)
        return seconds, read_tables(os.path.join(folder, "deck.dat"))


def read_tables(path):
    """Later blocks replace earlier ones of the same title (the words before "and time")."""
    tables, rows = {}, None
    with open(path) as file:
        for line in file:
            words = line.split()
            if not words:
                continue
            if " and time " in line:
                rows = tables[line.split(" and time ")[0].strip()] = []
            elif rows is not None:
                try:
                    rows.append([float(word) for word in words])
                except ValueError:  # an exponent of three digits
                    raise RuntimeError(f"{path}: unstable: {line.strip()}") from None
    return tables


def folder():
    return tempfile.mkdtemp(prefix="rival-")


class Table:
    """Rows written as they come, to a CSV and to the terminal."""

    def __init__(self, path, columns):
        self.columns, self.file = columns, open(path, "w")
        self.write(columns)

    def write(self, values):
        line = ",".join(f"{v:.6g}" if isinstance(v, float) else str(v) for v in values)
        print(line, file=self.file, flush=True)
        print(line, flush=True)

    def row(self, **values):
        self.write([values.get(column, "") for column in self.columns])
