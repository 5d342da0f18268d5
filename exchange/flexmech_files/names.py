"""Names of a deck, made of those that other programs allow."""

import re
import unicodedata

# Words that cards take in the place of a name.
RESERVED = {"rigid", "against", "free", "length", "forward", "backward", "left", "right", "open", "crossed", "shaft", "all"}


def unique(wish, taken):
    """The wish, or with a number that makes it another one."""
    name, number = wish, 1
    while name in taken:
        number += 1
        name = f"{wish}_{number}"
    return name


class Names:
    """Names that differ without regard to case; the same key has the same name."""

    def __init__(self, letter):
        self.letter = letter    # what begins a name that would begin otherwise
        self.given = {}
        self.taken = set(RESERVED)

    def __getitem__(self, key):
        return self.given[key]

    def give(self, key, wish=None):
        """The name of a key: of a new one like that which is wished, or like the key."""
        if key in self.given:
            return self.given[key]
        letters = "".join(letter for letter in unicodedata.normalize("NFKD", str(wish or key).strip()) if not unicodedata.combining(letter))
        base = re.sub(r"[^A-Za-z0-9_.'-]+", "_", letters).strip("_.-'")
        if not re.match(r"[A-Za-z]", base):
            base = self.letter + base
        # The names that are taken have small letters.
        name = base + unique(base.lower(), self.taken)[len(base):]
        self.taken.add(name.lower())
        self.given[key] = name
        return name
