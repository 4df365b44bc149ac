"""The exception of bad input and failed set-up steps."""


class Error(RuntimeError):
    """Bad input or a failed set-up step (a file, a scene, a setting, a device).

    The text is one line. It names the file, line, key or part, says what is wrong and, where it helps, what to do.

    Attributes
    ----------
    kind : str
        "file" (absent, damaged, or with impossible content), "setting" (a value is out of range), "overlap" (parts
        intersect at the start), "device" (it cannot be reached, or another application uses it) or "other".
    file : str
        Path; empty: none.
    line : int
        In the file, from 1 on; 0: none.
    key : str
        Dotted, as in scene files; empty: none.
    part : str
        Name of the part; empty: none.
    """

    def __init__(self, text: str, kind: str = "other", file: str = "", line: int = 0, key: str = "", part: str = ""):
        super().__init__(text)
        self.kind = kind
        self.file = file
        self.line = line
        self.key = key
        self.part = part
