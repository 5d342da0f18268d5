"""What is wrong with a file, and where."""


class FileError(Exception):
    """A message with its line and column, counted from 1, as far as there are any."""

    def __init__(self, message, line=None, column=None):
        super().__init__(message)
        self.line = line
        self.column = column

    def told(self, file):
        place = "".join(f":{number}" for number in (self.line, self.column) if number is not None)
        return f"{file}{place}: error: {' '.join(str(self).split())}"


def number_of(text, what, line=None, column=None):
    """A finite number, or a FileError that says what it should have been."""
    try:
        value = float(text)
    except (TypeError, ValueError):
        value = float("nan")
    if isinstance(text, bool) or not abs(value) < 1e30:
        raise FileError(f"expected a number for {what}, not {text!r}", line, column)
    return value
