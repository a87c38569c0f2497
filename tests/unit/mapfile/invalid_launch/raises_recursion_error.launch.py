def generate_launch_description():
    return generate_launch_description()
# expected: raises_recursion_error.launch.py:2: expected launch code that is understood here, found RecursionError: maximum recursion depth exceeded
