def generate_launch_description():
    return []
# expected: wrong_return.launch.py: expected a LaunchDescription from generate_launch_description, found list
