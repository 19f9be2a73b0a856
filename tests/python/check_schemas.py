#!/usr/bin/env python3
"""Holds documents against schemas with the package jsonschema: check_schemas.py SCHEMA DOCUMENT [SCHEMA DOCUMENT ...]"""

import json
import sys
from pathlib import Path

try:
    import jsonschema
except ImportError:
    print("skipped: Python has no jsonschema")
    raise SystemExit(0)

faults = []
for schema, document in zip(sys.argv[1::2], sys.argv[2::2]):
    schema, document = (json.loads(Path(name).read_text(encoding="utf-8")) for name in (schema, document))
    jsonschema.Draft202012Validator.check_schema(schema)
    faults += [f"{document}: {e.json_path}: {e.message}" for e in jsonschema.Draft202012Validator(schema).iter_errors(document)]
print(json.dumps(faults))
