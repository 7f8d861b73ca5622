"""A real archive (PACS) for tests of the panel: Debian's Orthanc on this machine's loopback, in a folder of its own, ended by
its process.
"""

import json
import os
import shutil
import socket
import subprocess
import time

PROGRAM = next((place for place in ("/usr/sbin/Orthanc", "/usr/bin/Orthanc") if os.path.exists(place)), None)


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def is_listening(port):
    with socket.socket() as one:
        return one.connect_ex(("127.0.0.1", port)) == 0


def make_certificates(folder):
    """An authority's, and a key and certificate for `archive` (127.0.0.1) and for `palpate`, as PEM in the folder."""
    curve = ["-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes"]

    def openssl(*arguments):
        subprocess.run(["openssl", *arguments], cwd=folder, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    openssl("req", "-x509", *curve, "-days", "2", "-subj", "/CN=authority", "-keyout", "authority.key", "-out", "authority.pem")
    for who, where in (("archive", "IP:127.0.0.1"), ("palpate", "DNS:workstation.example")):
        with open(os.path.join(folder, who + ".ext"), "w") as file:
            file.write("subjectAltName=" + where)
        openssl("req", *curve, "-subj", "/CN=" + who, "-keyout", who + ".key", "-out", who + ".csr")
        openssl("x509", "-req", "-days", "2", "-in", who + ".csr", "-CA", "authority.pem", "-CAkey", "authority.key",
                "-CAcreateserial", "-extfile", who + ".ext", "-out", who + ".pem")


class Orthanc:
    """Knows us as PALPATE, and sends to our port. With `tls` it speaks nothing else, and asks for our certificate."""

    def __init__(self, folder, tls=False):
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(os.path.join(folder, "store"))
        self.folder, self.port, self.ours = folder, free_port(), free_port()
        settings = {"Name": "for tests", "StorageDirectory": os.path.join(folder, "store"),
                    "IndexDirectory": os.path.join(folder, "store"), "HttpServerEnabled": False, "DicomServerEnabled": True,
                    "DicomAet": "ORTHANC", "DicomPort": self.port, "DicomCheckCalledAet": True, "DicomAlwaysAllowEcho": False,
                    "DicomAlwaysAllowStore": False, "DicomAlwaysAllowFind": False, "DicomAlwaysAllowGet": False,
                    "DicomModalities": {"palpate": {"AET": "PALPATE", "Host": "127.0.0.1", "Port": self.ours}},
                    "OverwriteInstances": True, "StableAge": 1, "Plugins": []}
        self.tls = []  # for DCMTK's programs
        if tls:
            make_certificates(folder)
            file = {name: os.path.join(folder, name) for name in os.listdir(folder)}
            settings |= {"DicomTlsEnabled": True, "DicomTlsCertificate": file["archive.pem"],
                         "DicomTlsPrivateKey": file["archive.key"], "DicomTlsTrustedCertificates": file["authority.pem"]}
            settings["DicomModalities"]["palpate"]["UseDicomTls"] = True
            self.tls = ["+tls", file["palpate.key"], file["palpate.pem"], "+cf", file["authority.pem"]]
        self.settings = os.path.join(folder, "orthanc.json")
        with open(self.settings, "w") as file:
            json.dump(settings, file)

    def __enter__(self):
        self.log = open(os.path.join(self.folder, "orthanc.log"), "w")
        self.process = subprocess.Popen([PROGRAM, self.settings], env=dict(os.environ, TCP_NODELAY="1"), stdout=self.log,
                                        stderr=self.log)
        for _ in range(3000):  # a busy machine; on a quiet one it takes a second
            if is_listening(self.port):
                return self
            if self.process.poll() is not None:
                break
            time.sleep(0.02)
        raise RuntimeError("Orthanc did not start: see " + self.log.name)

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait(60)
        self.log.close()

    def fill(self, folder):
        subprocess.run(["storescu", *self.tls, "-aet", "PALPATE", "-aec", "ORTHANC", "+sd", "+r", "127.0.0.1", str(self.port),
                        folder], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def options(self, *more):
        """As `palpate archive add NAME` takes them."""
        return ["--host", "127.0.0.1", "--port", str(self.port), "--called", "ORTHANC", "--calling", "PALPATE", "--listen",
                str(self.ours), "--listen-address", "127.0.0.1", *more]
