"""Reads a Parquet file of ours with `pyarrow`. Prints one JSON object: columns, values as hexadecimal floats, metadata."""

import json
import sys

try:
    import pyarrow.parquet as parquet
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(0)

table = parquet.read_table(sys.argv[1])
columns = [c.to_pylist() for c in table.columns]
print(json.dumps({
    "columns": table.column_names,
    "rows": [[v if isinstance(v, str) else v.hex() for v in row] for row in zip(*columns)],
    "metadata": {k.decode(): v.decode() for k, v in (table.schema.metadata or {}).items()},
}))
