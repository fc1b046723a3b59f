"""The other renderers' side of `tools/bench/peers`: a program that answers each line of JSON with one."""

import json
import sys

PREFIX = "peers: "  # before an answer: renderers print what they like


def serve(answers):
    """`answers(request)` returns what is sent back, or raises."""
    for line in sys.stdin:
        try:
            answer = answers(json.loads(line))
        except Exception as error:  # whatever a renderer raises belongs in the one line that is shown
            answer = {"error": f"{type(error).__name__}: {error}".splitlines()[0]}
        print(PREFIX + json.dumps(answer), flush=True)
