"""A client of a language server: a process that speaks JSON-RPC on its standard input and output.

https://microsoft.github.io/language-server-protocol/specifications/lsp/3.17/specification/
"""

import json
import subprocess
import threading
from contextlib import suppress
from itertools import count
from pathlib import Path
from queue import Empty, Queue

#: Seconds that an answer may take before the test fails; servers answer within parts of one.
PATIENCE = 60


class LanguageClient:
    """What an editor says to a server; settings that the server asks for are `settings`."""

    def __init__(self, command, cwd, settings=None, capabilities=None):
        self.process = subprocess.Popen(
            list(map(str, command)), stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=cwd
        )
        self.settings = settings or {}
        self.numbers = count(1)
        self.versions = {}
        self.diagnostics = {}
        self.messages = []
        self.stderr = []
        self._received = Queue()
        self._answers = {}
        threading.Thread(target=self._listen, daemon=True).start()
        threading.Thread(target=self._listen_to_errors, daemon=True).start()
        self.server = self.request(
            "initialize", {"processId": None, "rootUri": Path(cwd).as_uri(), "capabilities": capabilities or {}}
        )
        self.notify("initialized", {})

    def request(self, method, params):
        """The result of a request; fails for an error."""
        number = self.send_request(method, params)
        answer = self.answer(number)
        assert "error" not in answer, answer["error"]
        return answer["result"]

    def send_request(self, method, params):
        number = next(self.numbers)
        self._send({"id": number, "method": method, "params": params})
        return number

    def answer(self, number):
        while number not in self._answers:
            self._take()
        return self._answers.pop(number)

    def notify(self, method, params):
        self._send({"method": method, "params": params})

    def open(self, path, text=None, language="yaml"):
        """Open a file, or a text that is not saved yet; the diagnostics of it are returned."""
        self.start_open(path, text, language)
        return self.diagnostics_of(path)

    def start_open(self, path, text=None, language="yaml"):
        text = path.read_text() if text is None else text
        self.versions[path] = 1
        document = {"uri": path.as_uri(), "languageId": language, "version": 1, "text": text}
        self.notify("textDocument/didOpen", {"textDocument": document})

    def change(self, path, text):
        """Replace the whole text."""
        self.versions[path] += 1
        document = {"uri": path.as_uri(), "version": self.versions[path]}
        self.notify("textDocument/didChange", {"textDocument": document, "contentChanges": [{"text": text}]})

    def diagnostics_of(self, path):
        """The diagnostics of the newest text, once they are there."""
        while self.diagnostics.get(path.as_uri(), {}).get("version") != self.versions[path]:
            self._take()
        return self.diagnostics[path.as_uri()]["diagnostics"]

    def any_diagnostics_of(self, path):
        """The first diagnostics of a file, from a server that does not say of which version they are."""
        while path.as_uri() not in self.diagnostics:
            self._take()
        return self.diagnostics[path.as_uri()]["diagnostics"]

    def hover(self, path, line, character):
        """The text that is shown at a position, "" if there is none."""
        found = self.request("textDocument/hover", at(path, line, character))
        return found["contents"]["value"] if found else ""

    def end(self):
        """Shut down as the protocol says; the exit code."""
        self.request("shutdown", None)
        self.notify("exit", None)
        with suppress(BrokenPipeError):
            self.process.stdin.close()
        return self.process.wait(PATIENCE)

    def kill(self):
        self.process.kill()
        self.process.wait(PATIENCE)

    def _send(self, message):
        data = json.dumps({"jsonrpc": "2.0", **message}).encode()
        self.process.stdin.write(b"Content-Length: %d\r\n\r\n" % len(data) + data)
        self.process.stdin.flush()

    def _listen(self):
        stream = self.process.stdout
        while header := stream.readline():
            size = 0
            while header.strip():
                name, _, value = header.decode().partition(":")
                if name.lower() == "content-length":
                    size = int(value)
                header = stream.readline()
            self._received.put(json.loads(stream.read(size)))
        self._received.put(None)

    def _listen_to_errors(self):
        self.stderr += self.process.stderr

    def _take(self):
        try:
            message = self._received.get(timeout=PATIENCE)
        except Empty:
            message = None
        if message is None:
            raise AssertionError(f"no answer; standard error: {b''.join(self.stderr).decode()}")
        method = message.get("method")
        if method is None:
            self._answers[message["id"]] = message
        elif "id" in message:
            self._send({"id": message["id"], "result": self._wanted(method, message["params"])})
        elif method == "textDocument/publishDiagnostics":
            self.diagnostics[message["params"]["uri"]] = message["params"]
        else:
            self.messages.append(message)

    def _wanted(self, method, params):
        """What a server asks of an editor."""
        if method == "workspace/configuration":
            return [self.settings.get(item.get("section")) for item in params["items"]]
        return None


def at(path, line, character):
    """A position in a file, counted from 0."""
    return {"textDocument": {"uri": path.as_uri()}, "position": {"line": line, "character": character}}
