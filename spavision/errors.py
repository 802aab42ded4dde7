"""The one exception that means «the user can mend this»."""


class InputError(Exception):
    """Bad input, told in one sentence.

    The sentence names the file, the key or the option, says what was expected and how to mend it.
    The command line prints it on standard error and exits with code 2, without a traceback.
    """


class InputWarning(UserWarning):
    """Input that can be used, though something about it should be known; told in one sentence."""
