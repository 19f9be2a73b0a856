"""Reads an MCAP file of ours with the Python packages `mcap` and `mcap-protobuf-support`, as Foxglove's tools do.

Prints one JSON object: columns, the rows' values as hexadecimal floats, metadata, attachments.
"""

import json
import sys

try:
    from mcap.reader import make_reader
    from mcap_protobuf.decoder import DecoderFactory
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(0)

with open(sys.argv[1], "rb") as file:
    reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
    rows, columns, times = [], None, []
    for schema, channel, message, sample in reader.iter_decoded_messages():
        names = json.loads(channel.metadata["touchstone.columns"])
        fields = [f.name for f in sample.DESCRIPTOR.fields]
        columns = [names[name] for name in fields]
        values = [getattr(sample, name) for name in fields]
        rows.append([v if isinstance(v, str) else v.hex() for v in values])
        times.append(message.log_time)
    summary = reader.get_summary()
    print(json.dumps({
        "columns": columns,
        "rows": rows,
        "log_times": times,
        "topics": [c.topic for c in summary.channels.values()],
        "metadata": {m.name: m.metadata for m in reader.iter_metadata()},
        "attachments": {a.name: a.data.decode() for a in reader.iter_attachments()},
    }))
