"""JSON, with the line and column of what is wrong."""

import json

from .errors import FileError


def parse(text):
    """An object, or a FileError."""
    try:
        data = json.loads(text)
    except json.JSONDecodeError as fault:
        raise FileError(f"not JSON: {fault.msg}", fault.lineno, fault.colno) from None
    except RecursionError:
        raise FileError("not JSON of a linkage: it is nested too deeply") from None
    if not isinstance(data, dict):
        raise FileError("expected an object of JSON", 1, 1)
    return data


def place_of(text, word, which=0):
    """Line and column of a word in quotes, the first or a later one."""
    at = -1
    for _ in range(which + 1):
        at = text.find(json.dumps(word, ensure_ascii=False), at + 1)
        if at < 0:
            return None, None
    return text.count("\n", 0, at) + 1, at - text.rfind("\n", 0, at)


class Part:
    """An object of a file, that knows where it is: in messages, and for what is missing or wrong in it."""

    def __init__(self, data, what, place):
        self.data, self.what, self.place = data, what, place

    def error(self, message):
        return FileError(f"{self.what}: {message}", *self.place)

    def text(self, key, default=None):
        value = self.data.get(key, default)
        if not isinstance(value, str) or not value:
            raise self.error(f"expected a text for \"{key}\", not {json.dumps(value)}")
        return value

    def number(self, key, default=None):
        return self._number(self.data.get(key, default), key)

    def _number(self, value, key):
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not abs(value) < 1e30:
            raise self.error(f"expected a number for \"{key}\", not {json.dumps(value)}")
        return float(value)

    def pair(self, key, default=None):
        value = self.data.get(key, default)
        if not isinstance(value, (list, tuple)) or len(value) != 2:
            raise self.error(f"expected two numbers for \"{key}\", not {json.dumps(value)}")
        return tuple(self._number(item, key) for item in value)

    def names(self, key):
        value = self.data.get(key, [])
        if not isinstance(value, list) or not all(isinstance(item, str) for item in value):
            raise self.error(f"expected a list of texts for \"{key}\", not {json.dumps(value)}")
        return value


def parts(data, key, text, what):
    """The objects of a list, each with an \"id\", or of an object with names: name -> Part."""
    found = data.get(key, {})
    if isinstance(found, list):
        pairs = [(item.get("id", index) if isinstance(item, dict) else index, item) for index, item in enumerate(found, 1)]
    elif isinstance(found, dict):
        pairs = list(found.items())
    else:
        raise FileError(f"expected a list or an object for \"{key}\"", *place_of(text, key))
    named = {}
    for name, item in pairs:
        place = place_of(text, name) if isinstance(name, str) else place_of(text, key)
        if isinstance(name, (list, dict)):
            raise FileError(f"{what}: expected a text or a number for \"id\", not {json.dumps(name)}", *place)
        if not isinstance(item, dict):
            raise FileError(f"{what} {name}: expected an object", *place)
        if name in named:
            raise FileError(f"{what} {name} is there twice", *place)
        named[name] = Part(item, f"{what} {name}", place)
    return named
