def generate_launch_description(:
# expected: syntax_error.launch.py:1: expected launch code that is understood here, found SyntaxError: invalid syntax
