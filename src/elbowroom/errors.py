"""The one error a user sees: it names the file or option, the value, and the mend."""


class InputError(ValueError):
    """A file, a message or an argument from outside is wrong.

    The message is one line, fit to be shown as it is: what was read, which value was found there,
    and what is allowed or how to mend it. The command line prints it without a traceback and exits with 2.
    """


def in_a_line(value: object, most: int = 100) -> str:
    """What was found, whatever it is, as a message says it again: on one line, of `most` characters at the most."""
    return " ".join(str(value).split())[:most]
