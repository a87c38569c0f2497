def generate_launch_description():
    raise OSError("no map")
# expected: raises.launch.py:2: expected launch code that is understood here, found OSError: no map
