import os

os._exit(5)
# expected: ends_its_process.launch.py: expected launch code that returns, found that it ended the process that reads it, with exit status 5
