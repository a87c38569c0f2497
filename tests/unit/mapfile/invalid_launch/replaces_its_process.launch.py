import os

os.execvp("true", ["true"])
# expected: replaces_its_process.launch.py: expected launch code that returns, found that it ended the process that reads it, with exit status 0
