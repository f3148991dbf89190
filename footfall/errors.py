"""The one exception that a user's mistake raises."""

from __future__ import annotations

import os
import re
from typing import Self

_WORDS = (  # pydantic's, and ours
    (
        r"(?:Input|List|Tuple|String) should (?:be|have) (.*?)(?:, unable to .*| after validation.*)?$",
        r"expected \1",
    ),
    (r"expected greater than or equal to ", "expected at least "),
    (r"expected greater than ", "expected more than "),
    (r"expected less than or equal to ", "expected at most "),
    (r"expected a valid integer", "expected a whole number"),
    (r"expected a valid number", "expected a number"),
    (r"expected a valid string", "expected text"),
    (r"expected a valid boolean", "expected true or false"),
    (r"expected a valid (?:list|tuple)", "expected a list"),
    (r"expected a valid dictionary(?: or instance of \w+)?", "expected a table"),
)


def reworded(message: str) -> str:
    """What pydantic says of a value, in the words of our messages: "expected at least 0"."""
    for theirs, ours in _WORDS:
        message = re.sub(theirs, ours, message)
    return message


class InputError(ValueError):
    """An input (file, key, argument, recording) that cannot be used.

    Its text, "subject: message", is one sentence that names the culprit, its value and what was expected;
    the command line prints it and exits with code 2.

    Parameters
    ----------
    message : what is wrong, and what was expected
    subject : the culprit; None where the message names it
    more : lines that the command line prints below the sentence, such as a table of what was found

    Attributes
    ----------
    message, subject, more : as given, the subject as text
    """

    def __init__(self, message: str, subject: str | os.PathLike[str] | None = None, more: str = "") -> None:
        self.message = message
        self.subject = None if subject is None else os.fspath(subject)
        self.more = more
        super().__init__(message, self.subject, more)  # with these, a process hands it to another

    def __str__(self) -> str:
        return self.message if self.subject is None else f"{self.subject}: {self.message}"

    def about(self, subject: str | os.PathLike[str], *instead_of: str) -> Self:
        """The same mistake, said of a culprit that only the caller knows.

        Parameters
        ----------
        subject : put in front of the sentence, where it is not there yet
        instead_of : stand-ins, such as "recording": a subject of such a name makes way
        """
        subject = os.fspath(subject)
        known = self.subject in (subject, *instead_of)
        return type(self)(self.message if known else str(self), subject, self.more)
