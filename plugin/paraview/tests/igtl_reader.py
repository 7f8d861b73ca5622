"""Reads what is shared over OpenIGTLink: igtl_reader.py PORT SECONDS. Prints, as JSON, the last translation of each
transform, the last contact, how many frames came, and the names of what is drawn. Written from the protocol's pages
(openigtlink.org/developers/spec): big-endian, a header of 58 bytes."""

import json
import socket
import struct
import sys
import time

HEADER = struct.Struct(">H12s20sQQQ")


def name_of(raw):
    return raw.split(b"\0")[0].decode("utf-8")


def read(stream, size):
    data = b""
    while len(data) < size:
        more = stream.recv(size - len(data))
        if not more:
            raise EOFError
        data += more
    return data


def main():
    said = {"frames": 0, "drawn": [], "places": {}, "contact": None, "state": None}
    end = time.time() + float(sys.argv[2])
    with socket.create_connection(("127.0.0.1", int(sys.argv[1])), timeout=10) as stream:
        while time.time() < end:
            _, kind, device, _, size, _ = HEADER.unpack(read(stream, HEADER.size))
            kind, device, body = name_of(kind), name_of(device), read(stream, size)
            if kind == "TRANSFORM":
                said["places"][device] = struct.unpack(">12f", body)[9:]
                said["frames"] += device == "Proxy"
            elif kind == "STRING" and device == "PalpateContact":
                said["contact"] = json.loads(body[4:])
            elif kind == "STATUS":
                said["state"] = name_of(body[10:30])
            elif kind == "POLYDATA":
                said["drawn"].append(device)
    print(json.dumps(said))


main()
