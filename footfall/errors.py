"""The one exception that a user's mistake raises."""


class InputError(ValueError):
    """Something from outside (file, key, argument, recording) cannot be used.

    Its message is one sentence that names the culprit, its value and what was expected;
    the command line prints it and exits with code 2.
    """
