"""What ends a sweep before its end, with a sentence for whoever started it."""


class SweepError(Exception):
    """The sweep cannot go on; what is done is kept."""


class UsageError(SweepError):
    """The sweep that is asked for makes no sense: nothing was done."""
