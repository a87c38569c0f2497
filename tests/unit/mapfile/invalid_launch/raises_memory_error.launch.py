def generate_launch_description():
    raise MemoryError
# expected: raises_memory_error.launch.py:2: expected launch code that is understood here, found MemoryError
