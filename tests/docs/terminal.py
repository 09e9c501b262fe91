"""Runs the commands of a page one after another, as in a terminal; servers beside them, as in a second one."""

import os
import re
import signal
import subprocess

DEADLINE = 900  # s, of one command
SERVER = re.compile(r"^(?:\S*/)?irdm-server ")
BRIDGE = re.compile(r"^(?:\S*/)?irdm-bridge ")


class CommandFailed(RuntimeError):
    def __init__(self, command, status, printed):
        super().__init__(f"{command}: exit status {status}\n{printed}")
        self.status, self.printed = status, printed


class Terminal:
    """A server runs until another command than irdm-bridge comes; it gets a port of its own, by which the commands after
    it know it. In lockstep a server that records does so in lockstep, and ends with its bridge."""

    def __init__(self, folder, environment, lockstep):
        self.folder, self.environment, self.lockstep = folder, os.environ | environment, lockstep
        self.server = None
        self.server_ends = False  # by itself
        self.ports = {}  # as written to as it is
        self.address = ""  # of the last server

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.server:
            self.server.kill()
            self.server.wait()

    def run(self, command, beside=False):
        """What it printed; beside the server, if one runs."""
        if SERVER.match(command):
            self.end_server()
            return self.start_server(command)
        printed = "" if beside or BRIDGE.match(command) else self.end_server()
        return printed + self.run_to_end(self.with_ports(command))

    def run_to_end(self, command):
        """A change of the folder stays for the next command."""
        script = f"set -o pipefail\n{command}\nstatus=$?\npwd >&3\nexit $status"
        read, write = os.pipe()
        with open(read) as folder:
            done = subprocess.run(["bash", "-c", f"exec 3>&{write}\n{script}"], cwd=self.folder, env=self.environment,
                                  pass_fds=[write], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                  timeout=DEADLINE, check=False)
            os.close(write)
            if done.returncode != 0:
                raise CommandFailed(command, done.returncode, done.stdout)
            self.folder = folder.read().strip()
        return done.stdout

    def with_ports(self, text):
        for written, port in self.ports.items():
            text = text.replace(f":{written}", f":{port}")
        return text.replace("HOST:PORT", self.address)

    def start_server(self, command):
        """What it printed until it listens."""
        written = re.search(r"--port (\d+)", command)
        command = re.sub(r"--port \d+", "--port 0", command)
        self.server_ends = self.lockstep and "--record" in command
        if self.server_ends:
            command += " --lockstep"
        self.server = subprocess.Popen(["bash", "-c", f"exec {command} 2>&1"], cwd=self.folder, env=self.environment,
                                       stdout=subprocess.PIPE, text=True, start_new_session=True,
                                       preexec_fn=default_interrupt)
        printed = ""
        for line in self.server.stdout:
            printed += line
            if line.startswith("listening on http"):
                self.address = re.search(r"listening on ([\d.]+:\d+)", printed)[1]
                if written:
                    self.ports[written[1]] = self.address.rpartition(":")[2]
                return printed
        raise RuntimeError(f"{command} did not begin:\n{printed}")

    def end_server(self):
        """What it printed since it listens."""
        if not self.server:
            return ""
        if not self.server_ends:
            self.server.send_signal(signal.SIGINT)
        printed, _ = self.server.communicate(timeout=DEADLINE)
        status, self.server = self.server.returncode, None
        if status != 0:
            raise CommandFailed("irdm-server", status, printed)
        return printed


def default_interrupt():
    """What starts in the background ignores SIGINT, and so would the server."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
