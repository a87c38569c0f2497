import os

MODEL = os.environ["NO_SUCH_MODEL_OF_A_ROBOT"]


def generate_launch_description():
    return MODEL
# expected: raises_key_error.launch.py:3: expected launch code that is understood here, found KeyError: 'NO_SUCH_MODEL_OF_A_ROBOT'
