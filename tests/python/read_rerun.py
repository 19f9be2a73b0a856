"""Opens an MCAP file of ours with the importer of `rerun-sdk`. Prints one JSON object: what it found at which path."""

import json
import sys

try:
    from rerun.chunk import McapReader
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(0)

found, rows = set(), 0
for chunk in McapReader(sys.argv[1]).stream():
    found.add(str(chunk.entity_path))
    rows += chunk.num_rows if "recording" in str(chunk.entity_path) else 0
print(json.dumps({"paths": sorted(found), "rows": rows}))
