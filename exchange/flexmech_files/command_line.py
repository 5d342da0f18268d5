"""What both commands have in common: options, files to write, errors."""

import os
import sys
import tempfile

from . import program


class Wrong(Exception):
    """Something that the user has to change; exit status 2."""


def read_options(arguments, valued, flags):
    """Options as a dictionary (those that may be repeated have lists), and the other words. valued: option -> may be repeated."""
    options, words, rest = {}, [], list(arguments)
    while rest:
        word = rest.pop(0)
        name, equals, value = word.partition("=") if word.startswith("--") else (word, "", "")
        if word == "--":
            words += rest
            break
        if word == "-" or not word.startswith("-"):
            words.append(word)
        elif name in flags:
            if equals:
                raise Wrong(f"{name} takes no value: {word}")
            options[name] = True
        elif name in valued:
            value = value if equals or not rest else rest.pop(0)
            if not value:
                raise Wrong(f"{name} takes a value")
            if valued[name]:
                options.setdefault(name, []).append(value)
            elif name in options:
                raise Wrong(f"{name} is there twice")
            else:
                options[name] = value
        else:
            raise Wrong(f"unknown option {name}; --help lists them")
    return options, words


def write(text, path, force):
    """To standard output, or to a file, whole or not at all; one that is there stays, unless it is to be replaced."""
    # Names of files, and texts of JSON, may have halves of letters.
    data = text.encode("utf-8", errors="replace")
    if path is None:
        sys.stdout.buffer.write(data)
        sys.stdout.flush()
        return
    if os.path.isdir(path):
        raise Wrong(f"{path} is a folder")
    if os.path.exists(path) and not os.path.isfile(path):
        # A device or a pipe stays one.
        with open(path, "wb") as file:
            file.write(data)
        return
    if os.path.lexists(path) and not force:
        raise Wrong(f"{path} is there already; --force replaces it")
    # Behind a link the file is replaced, not the link.
    whole = os.path.realpath(path)
    try:
        handle, name = tempfile.mkstemp(prefix=".new-", dir=os.path.dirname(whole))
    except OSError as fault:
        raise Wrong(f"{path}: {fault.strerror}") from None
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(data)
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(name, 0o666 & ~mask)
        os.replace(name, whole)
    except OSError:
        os.unlink(name)
        raise


def run(command, arguments, usage, work):
    """Exit status of a command: --help and --version, then its work; what is wrong is told."""
    try:
        if "--help" in arguments:
            print(usage.strip())
        elif "--version" in arguments:
            print(f"{command} {program.version()}")
        else:
            work(arguments)
    except Wrong as fault:
        print(fault if str(fault).endswith("\n") or ": error: " in str(fault) else f"{command}: {fault}", file=sys.stderr)
        return 2
    except BrokenPipeError:
        sys.stderr.close()
        return 1
    except OSError as fault:
        print(f"{command}: {fault.filename or 'standard output'}: {fault.strerror}", file=sys.stderr)
        return 2
    return 0
