"""Parts of pages that tools/study and tools/report share: text in HTML, images in it, commands, the slider between images."""

import base64
import html


def text(value):
    return html.escape(str(value))


def embedded(path):
    return "data:image/png;base64," + base64.b64encode(path.read_bytes()).decode()


def commands(lines):
    if not lines:
        return ""
    shown = "\n".join(map(text, lines))
    word = "command" if len(lines) == 1 else "commands"
    return f"<details><summary>{word}</summary><pre tabindex=0>{shown}</pre></details>"


def choice(name, items, chosen):
    options = "".join(f'<option value="{index}"{" selected" if index == chosen else ""}>{text(item["label"])}</option>'
                      for index, item in enumerate(items))
    return f'<label>{name} <select class="{name}">{options}</select></label>'


def comparator(items, right=None):
    """Two of the images over each other, with a slider between them; shown where the script runs, which fills it. The right
    one is the last, or that of the number `right`."""
    choices = choice("left", items, 0) + choice("right", items, len(items) - 1 if right is None else right)
    return (f'<div class="compare" hidden><div class="choices">{choices}</div>'
            '<div class="stage"><img class="under" alt=""><img class="over" alt=""><i></i></div>'
            '<label class="slide">boundary <input type="range" min="0" max="100" value="50" step="1"></label></div>')
