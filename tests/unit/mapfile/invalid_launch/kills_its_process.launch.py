import os
import signal


def generate_launch_description():
    os.kill(os.getpid(), signal.SIGKILL)
# expected: kills_its_process.launch.py: expected launch code that returns, found that it was killed by SIGKILL
