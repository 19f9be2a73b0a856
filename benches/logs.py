#!/usr/bin/env python3
"""Times the loading of logs beside the readers of Python and writes one table; see benches/README.md.

    python3 benches/logs.py [--quick] [--out FILE]

Needs numpy, pandas, polars, pyarrow, mcap and mcap-protobuf-support; what is missing is skipped with a word.
"""

import argparse
import importlib
import json
import os
import platform
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TARGET = ROOT / (os.environ.get("CARGO_TARGET_DIR") or "target")


def optional(name):
    try:
        return importlib.import_module(name)
    except ImportError:
        print(f"skipped: the Python package {name} is not installed", file=sys.stderr)
        return None


numpy, pandas, polars, pyarrow = (optional(n) for n in ("numpy", "pandas", "polars", "pyarrow"))
mcap_reader = optional("mcap.reader")
mcap_protobuf = optional("mcap_protobuf.decoder")
mcap_json = optional("mcap.writer")
rerun = optional("rerun.chunk")


def program():
    build = ["cargo", "build", "--release", "--quiet", "-p", "estimator", "--example", "load_log"]
    subprocess.run(build, cwd=ROOT, check=True)
    return TARGET / "release/examples/load_log"


def ours(load_log, path):
    best, *_ = subprocess.run(
        [load_log, "load", path, "3"], check=True, capture_output=True, text=True
    ).stdout.split()
    return float(best)


def timed(work):
    """The best of three, as on our side."""
    best = float("inf")
    for _ in range(3):
        start = time.perf_counter()
        work()
        best = min(best, time.perf_counter() - start)
    return best


def mcap_messages(path):
    """Only unpacks the messages: the least that any reader does."""
    with open(path, "rb") as file:
        for _ in mcap_reader.make_reader(file).iter_messages():
            pass


def mcap_protobuf_columns(path):
    with open(path, "rb") as file:
        reader = mcap_reader.make_reader(file, decoder_factories=[mcap_protobuf.DecoderFactory()])
        names, rows = None, []
        for _, _, _, message in reader.iter_decoded_messages():
            names = names or [f.name for f in message.DESCRIPTOR.fields]
            rows.append([getattr(message, name) for name in names])
        numpy.array(rows)


def mcap_json_columns(path):
    with open(path, "rb") as file:
        rows = [json.loads(m.data) for _, _, m in mcap_reader.make_reader(file).iter_messages()]
        numpy.array([list(row.values()) for row in rows])


def make_json(path, table):
    """The same table as JSON messages, written by the Python package."""
    names = list(table.columns)
    with open(path, "wb") as file:
        writer = mcap_json.Writer(file)
        writer.start()
        schema = writer.register_schema("row", "jsonschema", b'{"type":"object"}')
        channel = writer.register_channel("/recording", "json", schema)
        for row in table.itertuples(index=False):
            ns = int(row[0] * 1e9)
            writer.add_message(channel, ns, json.dumps(dict(zip(names, row))).encode(), ns)
        writer.finish()


def cases(folder, load_log, sizes):
    for rows in sizes:
        for ending in ("csv", "mcap", "parquet"):
            subprocess.run([load_log, "make", folder / f"{rows}.{ending}", str(rows)], check=True)
        text = folder / f"{rows}.csv"
        if polars:
            yield f"CSV, {rows} rows", "polars", text, lambda p=text: polars.read_csv(p)
        if pandas:
            yield f"CSV, {rows} rows", "pandas", text, lambda p=text: pandas.read_csv(p)
        binary = folder / f"{rows}.mcap"
        if mcap_reader and mcap_protobuf and numpy:
            yield f"MCAP protobuf, {rows} rows", "mcap, messages only", binary, lambda p=binary: mcap_messages(p)
            yield f"MCAP protobuf, {rows} rows", "mcap + protobuf", binary, lambda p=binary: mcap_protobuf_columns(p)
        if rerun:
            # Their reader is compiled (Rust) and yields Arrow columns.
            read = lambda p: sum(chunk.num_rows for chunk in rerun.McapReader(p).stream())
            yield f"MCAP protobuf, {rows} rows", "rerun", binary, lambda p=binary: read(p)
        if mcap_reader and mcap_json and pandas and rows <= 60_000:
            packed = folder / f"{rows}-json.mcap"
            make_json(packed, pandas.read_csv(text))
            yield f"MCAP JSON, {rows} rows", "mcap + json", packed, lambda p=packed: mcap_json_columns(p)
        if pyarrow:
            table = folder / f"{rows}.parquet"
            parquet = importlib.import_module("pyarrow.parquet")
            yield f"Parquet, {rows} rows", "pyarrow", table, lambda p=table: parquet.read_table(p)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="60 000 rows only, one round")
    parser.add_argument("--out", type=Path, default=TARGET / "logs.json")
    options = parser.parse_args()
    load_log = program()
    rounds = 1 if options.quick else 3
    sizes = [60_000] if options.quick else [60_000, 1_000_000]
    rows = []
    print(f"{'what':28} {'MB':>7} {'ours s':>8} {'beside':>22} {'s':>8} {'times':>7}")
    with tempfile.TemporaryDirectory() as folder:
        for what, peer, path, work in cases(Path(folder), load_log, sizes):
            # In turns, so that a busy minute hits both.
            pairs = [(ours(load_log, path), timed(work)) for _ in range(rounds)]
            mine, theirs = (min(p[i] for p in pairs) for i in (0, 1))
            ratio = statistics.median(t / m for m, t in pairs)
            size = path.stat().st_size / 1e6
            print(f"{what:28} {size:7.1f} {mine:8.3f} {peer:>22} {theirs:8.3f} {ratio:7.2f}", flush=True)
            rows.append({"what": what, "mb": size, "ours_s": mine, "peer": peer, "peer_s": theirs, "ratio": ratio})
    options.out.parent.mkdir(parents=True, exist_ok=True)
    facts = {"machine": platform.processor(), "cores": os.cpu_count(), "load": os.getloadavg(), "rows": rows}
    options.out.write_text(json.dumps(facts, indent=2))


if __name__ == "__main__":
    main()
